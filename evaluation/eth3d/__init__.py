"""What is ETH3D's alone: its scenes, archives and submissions, and the paper's tables."""
