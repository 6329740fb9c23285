"""Dense stereo on many machines (docs/usage.md)."""
