"""What became slower, where, by how much: as text, as Markdown, and as a page with the history of each figure."""
import html

import baselines
import sources


def moved(before, now, most=8):
    """Functions by how much more, or fewer, of their instructions a step takes."""
    changes = {name: now.get(name, 0) - before.get(name, 0) for name in before.keys() | now.keys()}
    total = sum(before.values()) or 1
    # What has no row before was too small for one.
    least = {name: 2e-4 * total + (0 if name in before else baselines.KEPT * total) for name in changes}
    rows = [(count, name) for name, count in changes.items() if abs(count) > least[name]]
    return sorted(rows, key=lambda row: -abs(row[0]))[:most]


def lines_of(function, lines, changed, most=5):
    """The lines of a function that take most, those that are other than when it was accepted before all others; where
    the program knows its lines."""
    own = [(count, name.rsplit(" in ", 1)[0]) for name, count in lines.items() if name.endswith(" in " + function)]
    own = [(sources.is_changed(name, changed), count, name) for count, name in own
           if not name.endswith(":0") and not name.startswith("?")]
    return sorted(own, reverse=True)[:most]


def figure_row(row):
    verdict, name, old, new, by, limit = row
    share = f" ({100 * by:+.2f} %, {100 * limit:.2f} % allowed)" if by or limit else ""
    return f"{verdict:9} {name}: {old or 'none'} -> {new or 'none'}{share}"


def text(rows, where, lines, folder):
    told = [figure_row(row) for row in rows if row[0] != "as before"]
    changed = sources.changed_since_accepted(folder) if told else {}
    for case in sorted({row[1].split(": ")[0] for row in rows if row[0] in ("worse", "better") and "instructions" in row[1]}):
        told.append(f"\n{case}: instructions per step, by function")
        for count, function in moved(baselines.read_functions(folder, case), where.get(case, {})):
            told.append(f"  {count:+12.0f}  {function}")
            for is_new, of_line, place in lines_of(function, lines.get(case, {}), changed) if count > 0 else ():
                told.append(f"                  {of_line:12.0f} at {place}" + (", which has changed" if is_new else ""))
    if changed:
        told.append("\nchanged since figures were accepted:")
        told += [f"  {path}:{sources.spans(lines_there)}" for path, lines_there in sorted(changed.items())]
    same = sum(row[0] == "as before" for row in rows)
    told.append(f"\n{same} of {len(rows)} figures as before, {sum(row[0] == 'worse' for row in rows)} worse, "
                f"{sum(row[0] == 'better' for row in rows)} better, {sum(row[0] in ('new', 'gone') for row in rows)} new or gone")
    return "\n".join(told)


def markdown(rows):
    out = ["| verdict | figure | accepted | measured | change | allowed |", "| --- | --- | --- | --- | --- | --- |"]
    for verdict, name, old, new, by, limit in rows:
        out.append(f"| {verdict} | {name} | {old} | {new} | {100 * by:+.2f} % | {100 * limit:.2f} % |")
    return "\n".join(out) + "\n"


def spark(values):
    numbers = []
    for value in values:
        try:
            numbers.append(float(value))
        except ValueError:
            return ""
    if len(numbers) < 2 or max(numbers) == min(numbers):
        return ""
    low, high = min(numbers), max(numbers)
    points = " ".join(f"{4 + 112 * k / (len(numbers) - 1):.1f},{20 - 16 * (v - low) / (high - low):.1f}"
                      for k, v in enumerate(numbers))
    return f'<svg width="120" height="24" role="img"><polyline points="{points}" fill="none" stroke="currentColor"/></svg>'


PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Repose: figures</title>
<style>body{{font:15px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:70rem;padding:0 1rem;color:#222}}
table{{border-collapse:collapse;width:100%}}td,th{{text-align:left;padding:.2rem .6rem;border-bottom:1px solid #ddd}}
td.n{{font-variant-numeric:tabular-nums;white-space:nowrap}}tr.worse{{background:#fbe9e7}}tr.better{{background:#e8f5e9}}
pre{{background:#f6f6f4;padding:1rem;overflow:auto}}svg{{color:#555}}</style>
<h1>Figures of Repose</h1><p>{summary}</p><pre>{text}</pre>
<table><tr><th>figure<th>accepted<th>measured<th>change<th>allowed<th>history</tr>{rows}</table></html>
"""


def page(rows, told, folder):
    history = baselines.read_history(folder)
    cells = []
    for verdict, name, old, new, by, limit in rows:
        values = [value for _, value in history.get(name, [])] + ([new] if verdict in ("worse", "better") else [])
        cells.append(f'<tr class="{verdict}"><td>{html.escape(name)}<td class=n>{html.escape(old)}<td class=n>{html.escape(new)}'
                     f"<td class=n>{100 * by:+.2f} %<td class=n>{100 * limit:.2f} %<td>{spark(values)}</tr>")
    return PAGE.format(summary=html.escape(told.splitlines()[-1] if told else ""), text=html.escape(told), rows="".join(cells))
