"""Gain of remeshing while a strand moves."""
from .tables import known, records
from .words import number, percent, span, spaced, table

_WORTHWHILE = 1.5


def _rows(tables, part):
    return tables.ok_rows("adaptive_mesh", {"part": part})


def _count(tables, key):
    return tables.count("adaptive_mesh", key)


def _shown(tables):
    rows = _rows(tables, "elements")
    return rows[rows["gain"] > 0]


def _ratio(x):
    return number(x, 3) if x > 0 else ""


def gains(tables):
    measured = [[spaced(row["scene"]), percent(row["target_rel"]), number(row["elements_fixed"], 3), row["fixed_mesh"],
                 _ratio(row["gain"]), _ratio(row["gain_following"])] for row in records(_shown(tables))]
    limits = [[spaced(row["scene"]), "many elements", "", "", _ratio(row["gain"]), _ratio(row["gain_following"])]
              for row in records(_rows(tables, "limit"))]
    return table(["scene", "distance", "fixed elements", "their mesh", "remeshed", "following"],
                 sorted(measured + limits, key=lambda line: line[0]))


def _reached(tables, column, key):
    largest = _shown(tables)[column].max()
    return (f"{_count(tables, key)} of {_count(tables, 'elements')} measured cases reach {_WORTHWHILE}; the largest is "
            f"{number(largest, 3)}.")


def worth_anew(tables):
    return _reached(tables, "gain", "elements_remeshed")


def worth_following(tables):
    return _reached(tables, "gain_following", "elements_following")


def _between(gain):
    return span(gain, lambda x: number(x, 3))


def always_anew(tables):
    return _between(_shown(tables)["gain_always"])


def always_following(tables):
    return _between(_shown(tables)["gain_following_always"])


def verdict(tables):
    remeshed = _count(tables, "elements_remeshed") + _count(tables, "limit_remeshed")
    measured = _count(tables, "elements")
    always = (_shown(tables)["gain_following_always"] >= _WORTHWHILE).sum()
    return (f"Remeshing gains a factor of {_WORTHWHILE} in {remeshed} of {measured + _count(tables, 'limit')} cases, limits "
            f"included. Numbers of elements that follow the motion gain it in {_count(tables, 'elements_following')} of "
            f"{measured} measured cases by the rms error over a run, and in {always} where the worst instant counts")


def in_motion(tables):
    """Returns how many released hairs keep the tolerance, meshed for it and for a tighter one."""
    rows = _rows(tables, "in_motion")
    asked = rows["tolerance_rel"].max()
    half = rows[rows["tolerance_rel"] < asked]
    hairs = _count(tables, "hairs")
    return (f"{_count(tables, 'hairs_at_rest')} of {hairs} hairs keep a tolerance of {percent(asked)} of their length. Meshed "
            f"for a tolerance of {percent(half.iloc[0]['tolerance_rel'])}, {_count(tables, 'hairs_half')} of {hairs} keep "
            f"{percent(asked)}, and the largest error is {percent(half['tip_error_rel'].max())}.")


def pilot(tables):
    """Returns how many hairs meshed by pilot runs keep the tolerance."""
    rows = _rows(tables, "pilot")
    asked = rows.iloc[0]["tolerance_rel"]
    return (f"Of {_count(tables, 'hairs')} hairs, {_count(tables, 'hairs_pilot')} keep {percent(asked)} of their length by the "
            f"same measure, and {_count(tables, 'hairs_pilot_always')} at every joint and frame, with {span(rows['elements'])} "
            f"elements. For {(rows['work_rel'] == 3).sum()} of them the elements of rest were enough. The runs of a pilot have "
            f"{span(rows['work_rel'])} times the elements of the run that they prepare.")


def _with_points(tables):
    rows = _rows(tables, "points")
    return rows[known(rows["points_error_rel"])]


def points(tables):
    return table(["scene", "elements", "with more points", "from a fine mesh"],
                 [[spaced(row["scene"]), number(row["elements"]), percent(row["points_error_rel"]), percent(row["tip_error_rel"])]
                  for row in records(_with_points(tables))])


# Contact acts at the points.
_TOUCHING = ["edge", "fall_on_sphere"]


def points_verdict(tables):
    rows = _with_points(tables)
    share = rows["points_error_rel"] / rows["tip_error_rel"]
    touching = rows["scene"].isin(_TOUCHING)
    return (f"Where nothing touches, more points change the tip by at most {percent(share[~touching].max())} of the error of the elements. "
            "Points that follow the motion are therefore not implemented. Contact acts at the points: with contact, more points change "
            f"the tip by up to {percent(share[touching].max())} of that error, because they find a small body sooner. The option "
            "`quadrature` sets the number of points.")
