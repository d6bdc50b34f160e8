# SPDX-License-Identifier: MIT
"""The page of a run of curves."""

from cells import Table, interval, verdict_of
from efficiency import base_curve, explanation, finding, gain
from pages import Figure, Page, TableBlock, Text, Viewer
from run_document import (
    agreement_verdict,
    commit_of,
    experiment_path,
    gain_verdict,
    is_blind,
    is_stratified,
    label,
    slope_verdict,
    value,
)
from undecided import factor_of_agreement, factor_of_all, factor_of_gain, with_advice

BLIND = "not expected: light tracing does not see into mirrors and glass"
STRATIFIED = "not expected: stratified samples"


def gain_rows(run):
    """The thesis' gain of an algorithm over path tracing, in time and in samples."""
    expected = run.document["experiment"].get("expected_gain")
    if expected is None:
        return []
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    rows = []
    for key, of_run, words in (
        ("time", "seconds", "equal device time"),
        ("samples", "spp", "equal samples"),
    ):
        for curve in run.curves:
            if value(curve, "algorithm") == value(expected, "algorithm"):
                claimed, measured = value(expected, key), gain(base, curve, noise, of_run)
                verdict = with_advice(
                    gain_verdict(measured, claimed),
                    lambda: factor_of_gain(measured, claimed),
                    "seeds",
                )
                rows.append(
                    [
                        label(curve),
                        f"gain over {label(base)} in {words}",
                        f"{claimed:g} times",
                        interval(measured, form="{:.2f}"),
                        verdict,
                    ]
                )
    return rows


def slope_row(curve, expected, tolerance):
    slope = value(curve, "slope")
    if is_blind(curve) or is_stratified(curve):
        verdict = BLIND if is_blind(curve) else STRATIFIED
    else:
        verdict = with_advice(
            slope_verdict(slope, expected, tolerance),
            lambda: factor_of_all(slope, (expected - tolerance, expected + tolerance)),
            "seeds",
        )
    return [
        label(curve),
        "slope of log RMSE against log samples",
        f"{expected:g} ± {tolerance:g}",
        interval(slope, form="{:.4f}"),
        verdict,
    ]


def agreement_row(curve):
    agreement = value(curve, "agreement")
    verdict = (
        BLIND
        if is_blind(curve)
        else with_advice(agreement_verdict(agreement), lambda: factor_of_agreement(agreement))
    )
    return [
        label(curve),
        (
            f"mean over the reference, %; {value(agreement, 'rejected')} of"
            f" {value(agreement, 'tests')} blocks reject"
        ),
        "same image",
        interval(value(agreement, "relative_difference"), 100, "{:+.3f}"),
        verdict,
    ]


def verdict_table(run):
    """Quantity, claim, measurement and verdict by curve; gains, which decide, come first."""
    expected, tolerance = run.get("experiment.expected_slope.value"), run.get(
        "experiment.expected_slope.tolerance"
    )
    rows = gain_rows(run)
    rows += [slope_row(curve, expected, tolerance) for curve in run.curves]
    rows += [agreement_row(curve) for curve in run.curves]
    return Table(
        "Claims and measurements",
        ["curve", "quantity", "claimed", "measured", "verdict"],
        rows,
        [
            "Intervals of slopes and gains are of 95 %, those of the mean of 99 %. The image is the"
            " reference's if no block of 16 x 16 pixels rejects and the interval of the mean is"
            " within 0.1 %."
        ],
    )


def counted(rows, what):
    """How many of the rows with a verdict hold, and how many are undecided."""
    words = [word for word in map(verdict_of, (row[-1] for row in rows)) if word]
    undecided = words.count("undecided")
    return f"{words.count('holds')} of {len(words)} {what}" + (
        f" ({undecided} undecided)" if undecided else ""
    )


def finding_of(run):
    """The gain in equal time, or how many slopes and images are as claimed and which curve is the
    most efficient."""
    stated = finding(run)
    if stated:
        return stated
    expected, tolerance = run.get("experiment.expected_slope.value"), run.get(
        "experiment.expected_slope.tolerance"
    )
    slopes = counted(
        [slope_row(curve, expected, tolerance) for curve in run.curves],
        f"curves fall with a slope of {expected:g} ± {tolerance:g}",
    )
    images = counted(
        [agreement_row(curve) for curve in run.curves], "images agree with the reference"
    )
    return f"{slopes}; {images}. {most_efficient(run)}".strip()


def most_efficient(run):
    """The curve of the largest gain in equal device time, where the interval is above 1."""
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    gains = [
        (curve, gain(base, curve, noise, "seconds")) for curve in run.curves if curve is not base
    ]
    best, measured = max(gains, key=lambda entry: value(entry[1], "value"), default=(None, None))
    if best is None or value(measured, "low") <= 1:
        return (
            f"No curve has a higher efficiency than {label(base)} in equal device time."
            if gains
            else ""
        )
    return (
        f"In equal device time {label(best)} has the highest efficiency,"
        f" {interval(measured, form='{:.2f}')} times that of {label(base)}."
    )


def provenance(run):
    """Where the numbers come from, a line each."""
    context = run.get("context")
    load = [
        ", ".join(f"{average:.2f}" for average in value(context, f"load_average_{end}"))
        for end in ("start", "end")
    ]
    own, foreign, steal = (
        100 * value(context, f"cpu_use.{part}") for part in ("own", "foreign", "steal")
    )
    return [
        (
            f"commit {commit_of(context)},"
            f" profile {run.get('experiment.profile')}, {value(context, 'started_at')} to"
            f" {value(context, 'finished_at')}"
        ),
        (
            f"device: {value(context, 'device.name')}, {value(context, 'device.platform')}, driver"
            f" {value(context, 'device.driver')}, {value(context, 'device.c_version')},"
            f" {value(context, 'device.compute_units')} compute units; kernel options:"
            f" {value(context, 'kernel_options')}"
        ),
        (
            f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores,"
            f" {value(context, 'host.kernel')}; {value(context, 'host.compiler')},"
            f" {value(context, 'host.build_type')}"
        ),
        (
            f"load average {load[0]} at the start, {load[1]} at the end; CPU time: this run"
            f" {own:.0f} %, others {foreign:.0f} %, stolen {steal:.1f} %"
        ),
        (
            f"reference: {', '.join(run.get('reference.files'))}, {run.get('reference.engine')},"
            f" {run.get('reference.spp')} samples per pixel, noise RMSE"
            f" {run.get('reference.noise_floor.rmse'):.3g}, scene hash"
            f" {run.get('reference.scene_hash')}"
        ),
    ]


def made_by(run):
    """Device, commit, date and profile of a run, for the index."""
    context = run.get("context")
    return {
        "device": value(context, "device.name"),
        "commit": value(context, "commit") + (", changed" if context.get("dirty") else ""),
        "finished": value(context, "finished_at"),
        "profile": run.get("experiment.profile"),
    }


def viewer_block(run):
    """The viewer, or the command that makes the images it needs."""
    if run.has_images():
        from viewer import write_viewer

        write_viewer(run)
        return Viewer()
    name = run.get("experiment.name")
    return Viewer(
        "The interactive comparison needs the measured images, which the repository does not keep."
        f" This command makes them: rtrays-experiment run {experiment_path(name)} --profile"
        f" {run.get('experiment.profile')} --out DIR"
    )


def curve_page(run, tables, figures):
    """The page; `figures` are {file: caption} of the folder plots, the most decisive one first on
    the page."""
    table = verdict_table(run)
    first = "rmse_seconds_device.svg" if gain_rows(run) else "rmse_spp.svg"
    blocks = [Figure(f"plots/{first}", figures[first], png=True), TableBlock(table)]
    if explanation(run):
        blocks.append(Text(explanation(run)))
    blocks += [
        Figure(f"plots/{file}", caption, png=file.endswith(".svg"))
        for file, caption in figures.items()
        if file != first
    ]
    blocks.append(viewer_block(run))
    blocks += [TableBlock(table, f"tables/{name}") for name, table in tables.items() if table.rows]
    width, height = run.get("experiment.size")
    return Page(
        run.folder,
        "report.md",
        run.prose("title"),
        finding_of(run),
        blocks,
        source=run.source,
        claim=run.prose("claim"),
        claim_head="The thesis claims" if run.source else "Claim",
        provenance=provenance(run),
        verdicts=[word for word in (verdict_of(row[-1]) for row in table.rows) if word],
        picture="plots/reference.png",
        picture_label=f"Reference image, {width} x {height}",
        made=made_by(run),
    )
