# SPDX-License-Identifier: MIT
"""Where the numbers of a page come from: commit, device, host and load."""

from rtrays.documents.document import value
from rtrays.tables.text import name


def device_name(context):
    """Returns the name of the device in the context of a run."""
    return value(context, "device.name")


def commit_mark(context):
    """Returns the commit in twelve digits, and whether the tree had changes."""
    return value(context, "commit")[:12] + (", changed" if context.get("dirty") else "")


def made_by(context, profile):
    """Returns device, commit, date and profile of a run, for the overview."""
    return {
        "device": device_name(context),
        "commit": commit_mark(context),
        "finished": context.get("finished_at", ""),
        "profile": profile,
    }


def run_made_by(run):
    """Returns the entry of a run for the overview."""
    return made_by(run.get("context"), run.get("experiment.profile"))


def commit_text(context):
    """Returns the commit, and whether the tree had changes, as part of a sentence."""
    changed = " with uncommitted changes" if context.get("dirty") else ""
    return f"commit {value(context, 'commit')[:12]}{changed}"


def survey_provenance(run):
    """Returns commit, profile and device of a survey, a line each."""
    context = run.get("context")
    return [
        f"{commit_text(context)}, profile {run.get('experiment.profile')}",
        f"device: {device_name(context)}",
    ]


def load_text(context, when, digits):
    """Returns the load averages at the "start" or "end" of a run."""
    return ", ".join(f"{load:.{digits}f}" for load in value(context, f"load_average_{when}"))


def measurement_provenance(run):
    """Returns commit, device, host and load of a measurement, a line each."""
    context = run.get("context")
    units = "threads" if run.clock == "processor" else "compute units"
    lines = [
        f"{commit_text(context)}, profile {run.get('experiment.profile')},"
        f" {value(context, 'finished_at')}",
        f"device: {device_name(context)}, {value(context, 'device.compute_units')} {units}",
        f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores;"
        f" {value(context, 'host.compiler')}",
        f"load average at the start {load_text(context, 'start', 1)}; foreign processes used"
        f" {100 * value(context, 'cpu_use.foreign'):.0f} % of the processors",
    ]
    if run.get("absent"):
        lines.append(f"omitted because they are missing: {', '.join(map(name, run.get('absent')))}")
    return lines


def curve_provenance(run):
    """Returns commit, device, host, load and reference of a run of curves, a line each."""
    context = run.get("context")
    own, foreign, steal = (
        100 * value(context, f"cpu_use.{part}") for part in ("own", "foreign", "steal")
    )
    return [
        f"{commit_text(context)}, profile {run.get('experiment.profile')},"
        f" {value(context, 'started_at')} to {value(context, 'finished_at')}",
        f"device: {device_name(context)}, {value(context, 'device.platform')}, driver"
        f" {value(context, 'device.driver')}, {value(context, 'device.c_version')},"
        f" {value(context, 'device.compute_units')} compute units; kernel options:"
        f" {value(context, 'kernel_options')}",
        f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores,"
        f" {value(context, 'host.kernel')}; {value(context, 'host.compiler')},"
        f" {value(context, 'host.build_type')}",
        f"load average {load_text(context, 'start', 2)} at the start,"
        f" {load_text(context, 'end', 2)} at the end; CPU time: this run {own:.0f} %, others"
        f" {foreign:.0f} %, stolen {steal:.1f} %",
        f"reference: {', '.join(run.get('reference.files'))}, {run.get('reference.engine')},"
        f" {run.get('reference.spp')} samples per pixel, noise RMSE"
        f" {run.get('reference.noise_floor.rmse'):.3g}, scene hash"
        f" {run.get('reference.scene_hash')}",
    ]
