"""The summaries of the bar maps."""

import percute as pc
from studies.bar import Outcome, Setting
from studies.bar_maps import Summary


def test_a_summary_of_four_runs() -> None:
    """Effectivities of 0.5, 1, 2 and 0.7: from 0.5 to 2, half of them within 0.7 to 1.8."""
    settings = [Setting(elements, 0.5, 0.1, 2.0) for elements in (1, 2, 3, 4)]
    index = [pc.Effectivity(sup=sup, mean=0.0) for sup in (0.5, 1.0, 2.0, 0.7)]
    outcomes = [Outcome((2.0, 1.0), [(2.0 * each.sup, 0.0)], [each], [True]) for each in index]
    summary = Summary((outcome.effectivity(0)[0], setting) for outcome, setting in zip(outcomes, settings, strict=True))
    assert (summary.low, summary.low_at.elements) == (0.5, 1) and (summary.high, summary.high_at.elements) == (2.0, 3)
    assert (summary.count, summary.within, summary.ratio) == (4, 0.5, 4.0)


def test_the_impact_falls_where_the_setting_states() -> None:
    """With Δt = 0.9 Δt_c on 20 elements and a fraction of 0.5 the bar touches at the end of its second step."""
    setting = Setting(20, 0.9, 0.5, 2.0)
    outcome = setting.run([{"reconstruction": "corrected"}, {"reconstruction": "published"}])
    assert setting.step == 0.9 * 0.1 / 20 / (70e9 / 2700.0) ** 0.5
    # The estimates of the maps are those of percute.estimate: sup, mean, and both relative.
    assert len(outcome.estimates) == 2 and all(len(each) == 4 and min(each) > 0 for each in outcome.estimates)
    assert 0.9 < outcome.effectivity(0)[0] < 1.5
