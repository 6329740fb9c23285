"""What scripts/eth3d and scripts/benchmark are made of."""
