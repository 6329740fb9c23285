"""Dense stereo on many machines (docs/usage.md).

    commands.py  the program scripts/cluster: all jobs of a run, in order
    jobs.py      what each job does, as a script of the shell
    slurm.py     hands jobs to Slurm
    speed_up.py  the program scripts/cluster_speed_up: what more nodes would bring
"""
