"""Statements about one hair, tested on a family of hairs."""

from .family_words import PARAMETERS, STATEMENTS
from .tables import first, groups, records
from .words import coded, is_number, number, percent, plain, spaced, span, table

_RANGES = ["below 10", "10 to 100", "100 to 1000", "above 1000"]
_MEMBERS = {"hair": "hairs", "rods": "rods"}


def _named(parameter):
    return PARAMETERS.get(parameter, (spaced(parameter), ""))[0]


def _threshold(row):
    return f"{number(row['threshold'])} {PARAMETERS.get(row['decided_by'], ('', ''))[1]}".rstrip()


def _statement(row):
    return STATEMENTS.get(row["claim"], row["statement"])


def claim(tables, name, family="hair", range_="all"):
    """Returns the row of a claim, over all gravito-bending numbers by default."""
    return tables.row("family_summary", {"claim": name, "family": family, "range": range_})


def hairs(tables, family="hair"):
    """Returns the number of hairs, or of rods, in the family."""
    return tables.rows("family", {"family": family})["hair"].nunique()


def _share(row):
    return percent(row["holds_share"]) if row["hairs"] > 0 else "none"


def _held(row):
    return f"{_share(row)} of {row['hairs']} {_MEMBERS[row['family']]}"


def _change(x):
    """Returns a share in per cent; the least that is printed is 0.001 %."""
    return "less than 0.001 %" if x < 1e-5 else percent(x)


def _silent(row):
    return f" ({row['no_answer']} inconclusive)" if row["no_answer"] > 0 else ""


def _spread(row, text=number):
    return f"a median of {text(row['median'])} and deciles of {text(row['decile_1'])} and {text(row['decile_9'])}"


def _deciles(row):
    return ", ".join(map(number, (row["decile_1"], row["median"], row["decile_9"])))


def _rule(row):
    """Returns the property that predicts best for which hairs the statement is true; "": none does."""
    if not row["decided_by"]:
        return ""
    low, high, of = percent(row["share_below"]), percent(row["share_above"]), _MEMBERS[row["family"]]
    if row["decided_by"].startswith("drive is "):
        drive = spaced(row["decided_by"].removeprefix("drive is "))
        return f"the drive: the statement is true for {high} of the {of} with {drive} and for {low} of the others"
    sides = [(low, "below"), (high, "above")]
    (more, here), (less, there) = reversed(sides) if row["share_above"] > row["share_below"] else sides
    return (f"{_named(row['decided_by'])}: the statement is true for {more} of the {of} {here} {_threshold(row)} "
            f"and for {less} {there}")


def _sentence(tables, text, row):
    """Returns the statement for hair, its best predictor, and the share of the other rods."""
    rule = _rule(row)
    predictor = f". The best predictor is {rule}" if rule else ""
    return f"{text}{predictor}. The statement is true for {_held(claim(tables, row['claim'], 'rods'))} of other materials"


def _statements(tables, family):
    rows = tables.rows("family_summary", {"family": family, "range": "all"})
    return records(rows[rows["study"] != "tolerance"])


def summary(tables, family="hair"):
    """Returns one row per claim."""
    return table(
        ["statement", "true for", "decile, median, decile", "value", "strongest rank correlation"],
        [[_statement(row), f"{_held(row)}{f'; inconclusive: ' + coded(row['reasons']) if row['no_answer'] > 0 else ''}",
          _deciles(row) if row["hairs"] > 0 else "", coded(row["value"]),
          f"{_named(row['correlated_with'])} ({number(row['rank_correlation'])})" if is_number(row["rank_correlation"]) else ""]
         for row in _statements(tables, family)])


def _cell(held, all_of, silent):
    if all_of == 0:
        return f"{silent} inconclusive" if silent > 0 else ""
    return f"{percent(held / all_of)} of {all_of}{f'; {silent} inconclusive' if silent > 0 else ''}"


def ranges(tables, family="hair"):
    """Returns one row per claim, one column per range of the gravito-bending number."""
    def cell(row):
        return _cell(row["holds_share"] * row["hairs"], row["hairs"], row["no_answer"])

    return table(["statement", *_RANGES],
                 [[_statement(row), *(cell(claim(tables, row["claim"], family, of)) for of in _RANGES)]
                  for row in _statements(tables, family)])


def curls(tables):
    """Returns one row per claim about hair, one column per group of natural curvature."""
    rows = tables.rows("family", {"family": "hair"})
    kinds = rows.groupby("kind")["natural_curvature_per_m"].agg(["min", "max"]).sort_values("min")

    def cell(members):
        clear = members[members["status"] == "ok"]
        return _cell((clear["holds"] == "true").sum(), len(clear), len(members) - len(clear))

    def line(row):
        of = rows[rows["claim"] == row["claim"]]
        return [_statement(row), *(cell(of[of["kind"] == kind]) for kind in kinds.index)]

    return table(["statement", *(f"{kind}: {span(ends)} 1/m" for kind, ends in zip(kinds.index, kinds.values))],
                 [line(row) for row in _statements(tables, "hair")])


def population(tables):
    """Returns the ranges of the gravito-bending number and of the curvature that the hairs cover."""
    rows = tables.rows("family", {"family": "hair"})
    return (f"{hairs(tables)} hairs, Γ = {span(rows['gravito_bending'])}, natural curvature "
            f"{span(rows['natural_curvature_per_m'])} 1/m")


def exact_step(tables):
    twisted, bent = claim(tables, "exact_step_100ms"), claim(tables, "exact_step_100ms_bend")

    def ms(x):
        return f"{number(1e3 * x)} ms"

    return _sentence(
        tables, f"stable at every step tried up to 100 ms for {_held(twisted)}{_silent(twisted)}, and without twist for "
        f"{_share(bent)}. The largest stable step has a median of {ms(twisted['median'])} and a lowest decile of "
        f"{ms(twisted['decile_1'])} over the hairs", twisted)


def model_steps(tables):
    row = claim(tables, "super_helix_step_longer")
    return _sentence(tables, f"`super_helix` is stable at steps at least as long as `der` for {_held(row)}{_silent(row)}. The ratio "
                     f"of the largest steps has {_spread(row)}", row)


def twist_straight_share(tables):
    row = claim(tables, "twist_straight_negligible")
    return ("Leaving out twist displaces the tip of a hair straightened at rest by less than 1 % of its length for "
            f"{_held(row)}{_silent(row)}")


def twist_straight(tables):
    row = claim(tables, "twist_straight_negligible")
    return _sentence(tables, f"{twist_straight_share(tables)}. The displacement has {_spread(row, _change)}", row)


def by_range(tables, name):
    """Returns the share of hairs for which a claim is true, by range of the gravito-bending number."""
    return ", ".join(f"{_share(claim(tables, name, 'hair', of))} ({of})" for of in _RANGES)


def by_curl(tables, name):
    """Returns the share of hairs for which a claim is true, by group of natural curvature."""
    rows = tables.ok_rows("family", {"family": "hair", "claim": name}).sort_values("natural_curvature_per_m")
    return ", ".join(f"{percent((members['holds'] == 'true').mean())} ({kind})" for kind, members in groups(rows, "kind"))


def twist_curly(tables):
    row = claim(tables, "twist_curly_matters")
    return ("Leaving out twist displaces the tip of a hair with its own curls by more than 1 % of its length for "
            f"{_held(row)}{_silent(row)}. The displacement has {_spread(row, _change)}")


def bdf(tables):
    rows = [claim(tables, name) for name in ("bdf_order2_at_1e-2", "bdf_order2_at_1e-3", "bdf_order2_at_1e-4")]
    two, three, four = (percent(1 - row["holds_share"]) for row in rows)
    return (f"For a tip error of 1e-2 of the length, BDF needs fewer evaluations with order 5 than with order 2 on {two} of "
            f"{hairs(tables)} hairs. For 1e-3 it is {three} of them, and for 1e-4 {four}. The evaluations with order 5 over those with "
            f"order 2 have medians of {', '.join(number(row['median']) for row in rows)}")


def esdirk(tables):
    return (f"For 1e-3, ESDIRK takes no more steps than BDF on {_share(claim(tables, 'esdirk_steps_at_1e-3'))} of the hairs, and no "
            f"more evaluations on {_share(claim(tables, 'esdirk_work_at_1e-3'))}")


def equal(tables):
    row = claim(tables, "reduced_cheaper")
    return _sentence(tables, f"`super_helix` needs less time than `der` for a tip error of 1 % on {_held(row)}{_silent(row)}. The time "
                     f"of `der` over that of `super_helix` has {_spread(row)}. If one of the models never reaches this error, the "
                     "ratio counts as 100 or 0.01", row)


def equal_curly_wind(tables):
    """Returns "Of the 4 coily hairs in the wind it is true for 1"."""
    rows = tables.ok_rows("family", {"claim": "reduced_cheaper", "family": "hair", "kind": "coily", "drive": "wind"})
    return f"Of the {len(rows)} coily hairs in the wind it is true for {(rows['holds'] == 'true').sum()}"


def gravito_bending(tables):
    """Returns percentiles of the gravito-bending number over the hairs."""
    values = tables.rows("family", {"family": "hair", "claim": "exact_step_100ms"})["gravito_bending"]

    def at(part):
        return number(values.quantile(part))

    return f"{at(0.05)} (5 %), {at(0.5)} (50 %) and {at(0.95)} (95 %)"


# Claims about adaptive runs are made of every model and integrator; the whole family
# has tables of its own, which --quick does not make.
_NOT_STORED = "The stored tables hold no adaptive runs yet"


def _met(tables):
    return tables.rows("family_tolerance_summary", {"claim": "tolerance_met", "range": "all"})


def solved(tables, model, integrator):
    """Returns the number of hairs of a model and integrator: all, within the tolerance, unsolved, sensitive,
    without an answer."""
    rows = tables.rows("family_tolerance", {"claim": "tolerance_met", "model": model, "integrator": integrator})
    return {
        "all": len(rows),
        "within": (rows["holds"] == "true").sum(),
        "unsolved": _failed(rows).sum(),
        "sensitive": (rows["status"] == "sensitive").sum(),
        "silent": (~rows["status"].isin(["ok", "sensitive"])).sum(),
    }


def _failed(rows):
    return (rows["holds"] == "false") & (rows["failure"] != "")


def tolerance_table(tables):
    met = _met(tables)
    if met.empty:
        return f"{_NOT_STORED}."
    summaries = tables["family_tolerance_summary"]

    def spread_of(name, row):
        found = first(summaries[(summaries["claim"] == name) & (summaries["range"] == "all")
                                & (summaries["model"] == row["model"]) & (summaries["integrator"] == row["integrator"])])
        return _deciles(found) if found is not None and found["hairs"] > 0 else ""

    lines = []
    for row in records(met):
        count = solved(tables, row["model"], row["integrator"])
        lines.append([
            f"`{row['model']}`, `{row['integrator']}`",
            f"{count['within']} of {count['all']}{f', {count_of} sensitive' if (count_of := count['sensitive']) > 0 else ''}"
            f"{f', {count_of} inconclusive' if (count_of := count['silent']) > 0 else ''}",
            f"{count['unsolved']} of {count['all']}", _deciles(row), spread_of("tolerance_cheaper_at_error", row),
            spread_of("tolerance_cheaper_as_asked", row), _rule(row)])
    return table(["model, method", "within the tolerance", "no solution", "error: decile, median, decile",
                  "work ratio, same error", "work ratio, same tolerance", "best predictor"], lines)


def tolerances(tables):
    """Returns how the errors at one tolerance compare with those at ten times it."""
    rows = tables.rows("family_tolerances", {"study": "tolerances"})
    if rows.empty:
        return f"{_NOT_STORED}."
    warned = rows["warned"] == "true"
    return (f"{(rows['holds'] == 'true').sum()} of {len(rows)} pairs of runs hold ({rows['hair'].nunique()} hairs, "
            f"{rows['model'].nunique()} models, {rows['integrator'].nunique()} methods, {rows['position_tol_rel'].nunique()} "
            f"tolerances), {warned.sum()} by a warning. The largest ratio without a warning is "
            f"{number(rows['value'][~warned].max())}.")


def sensitive(tables):
    """Returns the hairs whose motion is sensitive, with growth and error."""
    rows = tables.rows("family_tolerance", {"claim": "tolerance_met", "status": "sensitive"})
    if rows.empty:
        return "None is among the stored hairs."
    named = (f"hair {row['hair']} with `{row['model']}`, `{row['integrator']}` (growth {number(row['growth'])}, error "
             f"{number(row['value'] / row['position_tol_rel'])} of the tolerance)" for row in records(rows))
    return f"Sensitive: {'; '.join(named)}."


def unsolved(tables):
    """Returns the hairs that neither method solves, by model."""
    rows = tables.rows("family_tolerance", {"claim": "tolerance_met"})
    if rows.empty:
        return _NOT_STORED
    words = []
    for model, failed in groups(_failed(rows), rows["model"]):
        by_hair = failed.groupby(rows["hair"]).all()
        lost = ", ".join(map(plain, by_hair.index[by_hair]))
        words.append(f"{by_hair.sum()}{f' ({lost})' if lost else ''} of {len(by_hair)} with `{model}`")
    return f"Hairs that neither method solves: {', '.join(words)}"


def tolerance(tables):
    """Returns the number of hairs that `tr_bdf2` keeps within its tolerance, by model."""
    met = _met(tables)
    met = met[met["integrator"] == "tr_bdf2"]
    if met.empty:
        return _NOT_STORED
    tolerances_of = tables.rows("family_tolerance", {"claim": "tolerance_met"})["position_tol_rel"].unique()
    counts = [solved(tables, row["model"], row["integrator"]) for row in records(met)]
    return (f"With a tolerance of {', '.join(map(percent, tolerances_of))} of the length, `tr_bdf2` keeps the error within the "
            f"tolerance on {span([one['within'] for one in counts])} of {span([one['all'] for one in counts])} hairs with each of "
            f"{len(counts)} models. Runs without a solution: {sum(one['unsolved'] for one in counts)}; inconclusive runs: "
            f"{sum(one['silent'] for one in counts)}")
