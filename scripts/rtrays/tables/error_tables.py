# SPDX-License-Identifier: MIT
"""Tables that say where the error of a run of curves is, and under which settings."""

from rtrays.documents.curves import base_curve, base_for, has_several_bases, label, own_curves
from rtrays.documents.document import value
from rtrays.documents.error_parts import (
    CLASSES,
    FULL,
    common_spp,
    errors,
    gain_in,
    has_parts,
    pixel_shares,
    present_classes,
    shares_of_error,
)
from rtrays.tables.cells import NONE, Lines, interval, number
from rtrays.tables.table import Table

PARTS = "Where the error is, by what the camera sees first"
GAINS = "Gain in equal samples, by what the camera sees first"


def percent(share):
    """Returns a share in percent, with enough digits for a hundredth of a percent."""
    return f"{100 * share:.2f}"


def parts_table(run):
    """Shares of pixels, and the shares of the mean squared error in them, by curve."""
    if not has_parts(run):
        return Table(PARTS, [], [])
    base, classes = base_curve(run), present_classes(run)
    pixels = pixel_shares(run)
    rows = [["(share of pixels)", NONE, NONE, *(percent(pixels[key]) for key in classes)]]
    rows[0] += [NONE] * 2
    for curve in run.curves:
        spp = common_spp(run, base, curve)
        shares = shares_of_error(run, curve, spp)
        mse, clipped, relmse = (errors(run, curve, spp, key).mean() for key in FULL)
        rows.append(
            [label(curve), str(spp), number(mse)]
            + [percent(shares[key]) for key in classes]
            + [number(clipped), number(relmse)]
        )
    return Table(
        PARTS,
        [
            "curve",
            "samples per pixel",
            "MSE",
            *(f"{CLASSES[key]}, % of MSE" for key in classes),
            "MSE of values clipped at 1",
            "relMSE",
        ],
        rows,
        [
            "Means over seeds; the noise of the reference is subtracted from the MSE and its parts."
            " A pixel shows a light behind a mirror or glass if a path from the camera through"
            " mirrors and smooth glass alone ends at a light. No connection finds these paths:"
            " there, light paths do not lower the noise of path tracing."
        ],
    )


def gains_table(run):
    """Gain of every curve over path tracing at equal samples, by class of pixel and metric. A run
    with several settings of path tracing names the one that has the curve's settings."""
    base, several = base_curve(run), has_several_bases(run)
    others = [curve for curve in run.curves if curve is not base]
    if not has_parts(run) or not others:
        return Table(GAINS, [], [])
    keys = ["mse", *present_classes(run), "mse_clipped", "relmse"]
    rows = []
    for curve in others:
        own = base_for(run, curve)
        gains = [gain_in(run, own, curve, key) for key in keys]
        rows.append(
            [label(curve), *([label(own)] if several else [])]
            + [interval(gain, form="{:.2f}") if gain else NONE for gain in gains]
        )
    return Table(
        GAINS if several else f"{GAINS}, over {label(base)}",
        ["curve", *(["over"] if several else []), *({**CLASSES, **FULL}[key] for key in keys)],
        rows,
        ["A dash: the noise of the reference hides the error."],
    )


# Settings that chapter 4 of the thesis names: name, path of the value in a curve, and the thesis'
# value.
PINNED = (
    *(
        (f"integrator.{name}", f"settings.integrator.{name}", thesis)
        for name, thesis in (
            ("sampler", "independent"),
            ("light_selection", "uniform"),
            ("sphere_sampling", "area"),
            ("beta", "2"),
            ("termination", "roulette"),
            ("roulette_start", "1"),
            ("light_paths", "pixels"),
        )
    ),
    ("device.bvh_layout", "render_report.bvh.layout", "bvh2"),
)
# Settings that are newer than some stored documents, with the value that these had.
NEWER = {"integrator.roulette_start": "1"}


def setting_of(curve, path):
    """Returns the value of a setting, or None if the document does not say."""
    group, _, key = path.partition(".")
    if group == "settings":
        return value(curve, group).get(key, NEWER.get(key))
    return value(curve, "render_report").get("bvh", {}).get("layout")


def values_of(run, path):
    """Returns the values of a setting as text: the common one first, then those of other curves
    with their names."""
    curves = {}
    for curve in own_curves(run):
        curves.setdefault(setting_of(curve, path), []).append(label(curve))
    ordered = sorted(curves.items(), key=lambda entry: -len(entry[1]))
    texts = [str(ordered[0][0])]
    return Lines(texts + [f"{found}: {', '.join(names)}" for found, names in ordered[1:]])


def settings_table(run):
    """The settings that chapter 4 of the thesis names, and ours; only ours in a run that is not
    about the thesis."""
    rows = [
        [name, thesis, values_of(run, path)]
        for name, path, thesis in PINNED
        if any(setting_of(curve, path) for curve in own_curves(run))
    ]
    if not run.source:
        return Table(
            "Settings",
            ["setting", "curves of this run"],
            [[name, values] for name, _, values in rows],
            ["Other settings are in run.json."],
        )
    return Table(
        "Settings that the thesis names",
        ["setting", "chapter 4 of the thesis", "curves of this run"],
        rows,
        [
            "The thesis selects a component of a material in proportion to its weight; here the"
            " Fresnel term counts, too. Other settings are in run.json."
        ],
    )
