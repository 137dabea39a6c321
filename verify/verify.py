#!/usr/bin/env python3
"""Published cases against the program: verify.py PROGRAM [--page FILE] [--jobs N] [NAME ..]

Runs the cases (all, or those that a NAME begins), prints a line for each figure, and writes the page of docs where --page
names it. Ends with 1 where a figure misses, a known miss passes, or a run does not end as it should."""
from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import contact
import magnets
import motion
import plates
import rods
import shells
import solids
import stability
from case import Case, Figure, Result

GROUPS = {
    "Plates": plates.CASES, "Shells": shells.CASES, "Stability": stability.CASES, "Rods": rods.CASES,
    "Magnets": magnets.CASES, "Solids": solids.CASES, "Contact and water": contact.CASES, "Motion": motion.CASES,
}


@dataclass(frozen=True)
class Outcome:
    case: Case
    figure: Figure
    value: float
    seconds: float  # CPU time of its runs

    @property
    def error(self) -> float:
        return (self.value - self.figure.reference) / abs(self.figure.scale or self.figure.reference)

    @property
    def passes(self) -> bool:
        return abs(self.error) <= self.figure.tolerance

    @property
    def expected(self) -> bool:
        return self.passes != bool(self.figure.miss)

    @property
    def verdict(self) -> str:
        if self.passes:
            return "pass" if not self.figure.miss else "passes, though it is a known miss"
        return "known miss" if self.figure.miss else "MISSES"


def run_scene(program: str, folder: Path, name: str, scene: dict, status: str) -> tuple[Result, float]:
    """Runs a scene, which is JSON, and so YAML; its result, and CPU seconds."""
    (folder / f"{name}.yaml").write_text(json.dumps({"slender": 1, **scene}))
    command = [program, "run", f"{name}.yaml", "-o", name, "--quiet", "--no-picture", "--threads", "1"]
    with open(folder / "said", "w+") as said:
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=said)
        _, code, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(code)
        said.seek(0)
        words = said.read().strip()
    result = folder / f"{name}.vtkhdf"
    if not result.exists():
        raise RuntimeError(words or f"code {process.returncode}")
    opened = Result(str(result))
    if status and opened.status != status:
        raise RuntimeError(f"{opened.status}, not {status}: {words}")
    return opened, used.ru_utime + used.ru_stime


def run_case(program: str, case: Case) -> list[Outcome]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in case.files.items():
            (folder / file).write_text(text)
        runs = [run_scene(program, folder, f"scene{k}", scene, case.status) for k, scene in enumerate(case.scenes)]
        results, seconds = [r for r, _ in runs], sum(s for _, s in runs)
        return [Outcome(case, figure, float(figure.read(*results)), seconds) for figure in case.figures]


def shown(value: float) -> str:
    return f"{value:.6g}"


def percent(part: float) -> str:
    return "0" if part == 0 else f"{100 * part:+.2g} %"


def row(outcome: Outcome) -> str:
    case, figure = outcome.case, outcome.figure
    cells = (case.name, figure.what, case.source, case.mesh, shown(figure.reference), shown(outcome.value),
             percent(outcome.error), percent(figure.tolerance)[1:], f"{outcome.seconds:.1f}", outcome.verdict)
    return "| " + " | ".join(cells) + " |"


def write_page(path: Path, groups: dict[str, list[Outcome]]) -> None:
    """The tables go in place of what follows the page's last line of prose."""
    mark = "<!-- made by ./do verify -->\n"
    text = path.read_text().split(mark)[0] + mark
    for group, outcomes in groups.items():
        text += f"\n## {group}\n\n| case | figure | source | mesh | reference | slender | error | allowed | CPU s | |\n"
        text += "|---|---|---|---|---|---|---|---|---|---|\n" + "".join(row(o) + "\n" for o in outcomes)
    misses = [o for outcomes in groups.values() for o in outcomes if o.figure.miss]
    if misses:
        text += "\n## Known misses\n\n"
        text += "".join(f"- {o.case.name}, {o.figure.what}: {o.figure.miss}\n" for o in misses)
    path.write_text(text)


def chosen(case: Case, names: list[str]) -> bool:
    return not names or any(case.name.startswith(name) for name in names)


def collect(runs: list[tuple[Case, Future]]) -> tuple[list[Outcome], int]:
    """What came out, and how much of it is not as it should be."""
    outcomes, wrong = [], 0
    for case, run in runs:
        try:
            found = run.result()
        except (RuntimeError, KeyError, OSError) as error:
            print(f"{case.name}: {error}", flush=True)
            wrong += 1
            continue
        for o in found:
            print(f"{case.name}, {o.figure.what}: {shown(o.value)}, reference {shown(o.figure.reference)}, "
                  f"{percent(o.error)} of {percent(o.figure.tolerance)[1:]}, {o.seconds:.1f} s: {o.verdict}", flush=True)
        outcomes += found
        wrong += sum(not o.expected or math.isnan(o.value) for o in found)
    return outcomes, wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="slender")
    parser.add_argument("names", nargs="*", metavar="NAME", help="cases whose names begin so")
    parser.add_argument("--page", type=Path, help="docs/verification.md, where all cases are run")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="how many cases run at a time")
    options = parser.parse_intermixed_args()
    program, wrong, groups = str(Path(options.program).resolve()), 0, {}
    with ThreadPoolExecutor(options.jobs) as pool:
        runs = {group: [(c, pool.submit(run_case, program, c)) for c in cases if chosen(c, options.names)]
                for group, cases in GROUPS.items()}
        for group, started in runs.items():
            groups[group], bad = collect(started)
            wrong += bad
    if not any(groups.values()) and not wrong:
        parser.error("no case has such a name")
    if options.page and not options.names:
        write_page(options.page, groups)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
