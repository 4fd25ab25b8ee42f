"""What the tables of figures have in common: results of the benchmarks, numbers as text, the machine, the page."""

import json
import os
import re
import sys
from pathlib import Path

TIMES = ("real_time", "cpu_time", "per_particle", "per_impact", "per_problem", "per_event", "per_second", "per_rod",
         "eigen_per_rod", "per_wheel", "seconds", "per_unknown", "per_disc", "per_box", "per_step", "ms")


def load(folder, program):
    """Context and, for each case, the least of every time and the most of every count over its repetitions."""
    file = folder / f"{program}.json"
    if not file.exists():
        return None, None
    data = json.loads(file.read_text())
    cases = {}
    for run in data["benchmarks"]:
        if run["run_type"] != "iteration" or run.get("error_occurred"):
            continue
        name = "/".join(part for part in run["name"].split("/") if ":" not in part)
        case = cases.setdefault(name, {})
        for key, value in run.items():
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                case[key] = (min if key in TIMES else max)(case.get(key, value), value)
        case["unit"] = run["time_unit"]
    return data["context"], cases


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def figure(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def seconds(case):
    return case["cpu_time"] * {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[case["unit"]]


def machine(context, compiler, began, idle=1.2):
    """What was measured on. Up to `idle` is the load of the benchmark before."""
    cpu = "unknown processor"
    if Path("/proc/cpuinfo").exists():
        found = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
        cpu = found.group(1) if found else cpu
    cpu = cpu.replace("(R)", "").replace("(TM)", "")
    load = context.get("load_avg", [0.0])[0]
    return (f"{cpu}, {os.cpu_count()} cores; {compiler}, Release. Measured {context['date'][:10]}; "
            f"load of the machine when {began} began: {load:.1f}."
            + (" The machine was busy: a run on an idle one is due." if load > idle else ""))


def replace_parts(page, parts):
    """Writes each part between its marks on a page."""
    text = page.read_text()
    for name, part in parts.items():
        text, count = re.subn(rf"(<!-- measured: {name} -->\n).*?(\n<!-- end -->)",
                              lambda match: match.group(1) + part + match.group(2), text, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"{page}: section '{name}' is there {count} times")
    page.write_text(text)
