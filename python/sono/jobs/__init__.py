"""What the commands have done: jobs with their files, checkpoints, locks and rows, here or on a cluster.

May import everything but `cli`.
"""
