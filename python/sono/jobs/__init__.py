"""What the commands have done: jobs with their files, checkpoints, locks and rows, here or on a cluster.

May import `curve`, `formats`, `invariants`, `naming`, `patience`, `printing`, `searching`, `shape`, `starts`,
`tables` and `tightening`.
"""
