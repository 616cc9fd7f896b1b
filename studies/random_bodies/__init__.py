"""Random bodies: effectivity indices in cases on which nothing was tuned, beside the ranges that verdicts state.

``python -m studies.random_bodies --seed 0 --count 20`` prints them; ``docs/verdict.md`` describes columns and aims. A seed alone
determines its body; meshes of Gmsh and of matplotlib are the same with the same versions of these.

A reference has elements of a quarter of the size, and where a corner or a curve touches, of an eighth to a 128th, the finest that takes some
ten seconds. With elements of half the size, there or everywhere, the indices of eight such impacts change by at most 2 %, those of one slow impact
with a 32nd by 8 %; a quarter everywhere would make indices up to 44 % larger. Where an edge touches or nothing, elements are of an eighth if that
does not take longer, else of a quarter, which gives up to 7 % more, most in brackets with sharp inner corners.
"""
