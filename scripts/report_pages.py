# SPDX-License-Identifier: MIT
"""The report of a run as Markdown and as one static HTML page with relative links and no network."""

import html
import os
import re

from efficiency import base_curve, explanation, gain
from run_document import agreement_verdict, gain_verdict, is_blind, is_stratified, label, slope_verdict, value, write_text
from tables import Table, interval
from viewer import write_viewer

STYLE = """
body { font: 16px/1.5 Georgia, serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1, h2 { font-weight: normal; line-height: 1.2; }
table { border-collapse: collapse; font: 13px/1.4 system-ui, sans-serif; border-top: 2px solid; border-bottom: 2px solid; }
th { border-bottom: 1px solid; text-align: left; }
th, td { padding: .25rem .8rem .25rem 0; font-variant-numeric: tabular-nums; vertical-align: top; }
.wide { overflow-x: auto; width: max-content; max-width: min(84rem, 100vw - 3rem, 50vw + 28rem); }
.controls label { margin-right: 1rem; font: 13px system-ui, sans-serif; white-space: nowrap; }
.frame { overflow: auto; margin-top: .5rem; } canvas { image-rendering: pixelated; cursor: col-resize; }
.readout { font: 12px ui-monospace, monospace; min-height: 1.5em; white-space: pre; }
td[data-verdict] { white-space: nowrap; } td[data-verdict]::before { margin-right: .4em; }
td[data-verdict="holds"]::before { content: "●"; color: #009e73; }
td[data-verdict="holds partly"]::before { content: "◐"; color: #e69f00; }
td[data-verdict="does not hold here"]::before { content: "○"; color: #d55e00; }
td[data-verdict="undecided"]::before { content: "?"; color: #777; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); gap: 1rem; }
.cards a { border: 1px solid #ccc; color: inherit; text-decoration: none; font-size: .9rem; line-height: 1.3; }
.cards img { display: block; width: 100%; height: 10rem; object-fit: contain; background: #f6f6f6; }
.cards span { display: block; padding: .6rem .8rem; } .cards a:hover span { text-decoration: underline; }
figure { margin: 1.5rem 0; } img { max-width: 100%; } figcaption, footer { color: #555; font-size: .85rem; }
footer { border-top: 1px solid #ccc; margin-top: 3rem; }
"""


def verdict_table(run):
    """Claim, measurement and verdict, by curve."""
    expected, tolerance = run.get("experiment.expected_slope.value"), run.get("experiment.expected_slope.tolerance")
    rows = []
    for curve in run.curves:
        blind = "not expected: it sees nothing in mirrors and glass" if is_blind(curve) else None
        rows.append([label(curve), f"slope {expected} ± {tolerance}", interval(value(curve, "slope"), form="{:.4f}"),
                     blind or (is_stratified(curve) and "not expected: stratified samples")
                     or slope_verdict(value(curve, "slope"), expected, tolerance)])
        agreement = value(curve, "agreement")
        measured = (f"mean {interval(value(agreement, 'relative_difference'), 100, '{:+.3f}')} %, "
                    f"{value(agreement, 'rejected')} of {value(agreement, 'tests')} block tests reject")
        rows.append([label(curve), "the reference's image", measured, blind or agreement_verdict(agreement)])
    rows += gain_rows(run)
    return Table("Claim, measurement, verdict", ["curve", "thesis", "measured", "verdict"], rows)


def gain_rows(run):
    """What the thesis says that an algorithm gains over path tracing, in samples and in time."""
    expected = run.document["experiment"].get("expected_gain")
    if expected is None:
        return []
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    rows = []
    for curve in run.curves:
        if value(curve, "algorithm") == value(expected, "algorithm"):
            for key, of_run, words in (("samples", "spp", "samples"), ("time", "seconds", "device time")):
                claimed = value(expected, key)
                measured = gain(base, curve, noise, of_run)
                rows.append([label(curve), f"{claimed} times fewer {words}" if key == "samples" else f"{claimed} times less {words}",
                             interval(measured, form="{:.2f}"), gain_verdict(measured, claimed)])
    return rows


def provenance(run):
    """Where the numbers come from, a line each."""
    context = run.get("context")
    load = [", ".join(f"{average:.2f}" for average in value(context, f"load_average_{end}")) for end in ("start", "end")]
    own, foreign, steal = (100 * value(context, f"cpu_use.{part}") for part in ("own", "foreign", "steal"))
    return [
        f"commit {value(context, 'commit')}{' with uncommitted changes' if value(context, 'dirty') else ''}, "
        f"profile {run.get('experiment.profile')}, {value(context, 'started_at')} to {value(context, 'finished_at')}",
        f"device: {value(context, 'device.name')}, {value(context, 'device.platform')}, driver "
        f"{value(context, 'device.driver')}, {value(context, 'device.c_version')}, "
        f"{value(context, 'device.compute_units')} compute units; kernel options: {value(context, 'kernel_options')}",
        f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores, {value(context, 'host.kernel')}; "
        f"{value(context, 'host.compiler')}, {value(context, 'host.build_type')}",
        f"load average {load[0]} at the start, {load[1]} at the end; CPU time: this run {own:.0f} %, others "
        f"{foreign:.0f} %, stolen {steal:.1f} %",
        f"reference: {', '.join(run.get('reference.files'))}, {run.get('reference.engine')}, "
        f"{run.get('reference.spp')} spp together, noise RMSE {run.get('reference.noise_floor.rmse'):.3g}, "
        f"scene hash {run.get('reference.scene_hash')}",
    ]


def title(run):
    return f"{run.get('experiment.title')} (thesis, {run.get('experiment.thesis')})"


def markdown_page(run, tables, figures):
    parts = [f"# {title(run)}", f"The thesis claims: {run.get('experiment.claim')}", verdict_table(run).markdown()]
    parts += [text for text in [explanation(run)] if text]
    parts += [f"![{caption}](plots/{file})\n\n{caption}" for file, caption in figures.items()]
    parts += [f"## {table.caption}\n\n{table.markdown()}" for table in tables.values()]
    parts += ["---", "\n".join(f"- {line}" for line in provenance(run))]
    return "\n\n".join(parts) + "\n"


def html_table(table):
    def cells(tag, row):
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row) + "</tr>"

    return ("<div class=wide><table><thead>" + cells("th", table.columns) + "</thead><tbody>"
            + "\n".join(cells("td", row) for row in table.rows) + "</tbody></table></div>")


VERDICT_CELL = re.compile("<td>(?=(holds partly|holds|does not hold here|undecided)(<|,))")
INTERVAL = re.compile(r"(\[[-+\d.e]+,) ([-+\d.e]+\])")


def html_document(heading, body):
    body = INTERVAL.sub("\\1\N{NO-BREAK SPACE}\\2", VERDICT_CELL.sub(r'<td data-verdict="\1">', body))
    return (f"<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><title>{html.escape(heading)}</title>"
            f"<style>{STYLE}</style></head>\n<body><h1>{html.escape(heading)}</h1>\n{body}\n</body></html>\n")


def html_page(run, tables, figures):
    parts = [f"<p>The thesis claims: {html.escape(run.get('experiment.claim'))}</p>", html_table(verdict_table(run)),
             f"<p>{html.escape(explanation(run))}</p>"]
    for file, caption in figures.items():
        text = html.escape(caption)
        link = f' <a href="plots/{file[:-4]}.png">PNG</a>' if file.endswith(".svg") else ""
        parts.append(f'<figure><img src="plots/{file}" alt="{text}"><figcaption>{text}{link}</figcaption></figure>')
    parts.append(f"<h2>Images</h2>{write_viewer(run)}")
    for name, table in tables.items():
        links = ", ".join(f'<a href="tables/{name}.{form}">{form}</a>' for form in ("csv", "md", "tex"))
        parts.append(f"<h2>{html.escape(table.caption)}</h2>{html_table(table)}<p>{links}</p>")
    parts.append('<p><a href="tables/repetitions.csv">every repetition</a>, <a href="run.json">run.json</a></p>')
    parts.append("<footer><ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in provenance(run)) + "</ul></footer>")
    return html_document(title(run), "\n".join(parts))


def markdown_pages(folder):
    """Makes index.html of every NAME/NAME.md, which other programs wrote; (title, path) of each, the claims first."""
    import markdown

    for source in sorted(folder.glob("*/*.md"), key=lambda path: (path.stem != "claims", path)):
        if source.stem == source.parent.name:
            heading, _, text = source.read_text().partition("\n")
            page = source.with_name("index.html")
            body = markdown.markdown(text, extensions=["tables"])
            body = body.replace("<table>", "<div class=wide><table>").replace("</table>", "</table></div>")
            write_text(page, html_document(heading.lstrip("# "), body))
            yield heading.lstrip("# "), page


def card(folder, heading, page, picture):
    """A link to a page with one of its pictures, where it has any."""
    shown = f'<img src="{html.escape(os.path.relpath(picture, folder))}" alt="">' if picture and picture.exists() else ""
    return f'<a href="{html.escape(os.path.relpath(page, folder))}">{shown}<span>{html.escape(heading)}</span></a>'


def html_index(folder, runs, overview):
    """How many claims hold, section by section, and links to all pages: those of curves, then those of measurements."""
    (claims, claims_page), *measured = markdown_pages(folder)
    cards = [card(folder, title(run), run.folder.resolve() / "index.html", run.folder.resolve() / "plots/reference.png") for run in runs]
    cards += [card(folder, heading, page, next(iter(sorted(page.parent.glob("*.svg"))), None)) for heading, page in measured]
    return html_document("RTRays: chapter 4", "\n".join([
        f'<h2><a href="{html.escape(os.path.relpath(claims_page, folder))}">{html.escape(claims)}</a></h2>', html_table(overview),
        "<h2>Experiments</h2>", f"<div class=cards>{''.join(cards)}</div>"]))
