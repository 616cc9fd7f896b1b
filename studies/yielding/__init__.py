"""Bars that yield in an impact: exact solutions, and true errors of computed ones.

`bar` has the data and the law, `front_tracking` the exact solution, `distance` the true error of a history, and
`explicit_bar` computes histories. They follow the specification of plasticity. NumPy alone is needed.
"""
