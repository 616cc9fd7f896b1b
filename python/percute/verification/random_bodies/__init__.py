"""Random bodies: effectivity indices in cases on which nothing was tuned, beside the ranges that verdicts state.

``python -m percute.verification.random_bodies --seed 0 --count 20`` prints them; ``docs/verdict.md`` describes columns and aims.
"""
