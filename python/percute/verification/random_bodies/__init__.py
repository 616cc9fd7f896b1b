"""Random bodies: effectivity indices in cases on which nothing was tuned, beside the ranges that verdicts state.

``python -m percute.verification.random_bodies --seed 0 --count 20`` prints them; ``docs/verdict.md`` describes columns and aims. A seed alone
determines its body; meshes of Gmsh and of matplotlib are the same with the same versions of these.

A reference has elements of a quarter of the size, and where a corner or a curve touches, of a 32nd, in short runs of a 128th. With further elements
of half the size, there or everywhere, the indices of four short runs change by at most 1 %, those of four long ones by at most 2 %. A quarter
everywhere would make them up to 44 % larger, most in slow impacts. Where an edge touches or nothing, elements are of an eighth in short runs. In
long runs a quarter gives up to 7 % more than an eighth, most in brackets with sharp inner corners.
"""
