"""The gallery: every scene that has something to show, solved, compared with its reference and drawn.

gallery.py --build DIR [--jobs N] [--only NAME...] [--renew-figures]; all goes to DIR/gallery, with index.html on top
(some.html, if only some were asked for). A run that is newer than its inputs is kept. Exits with 1 if a comparison
fails or a scene does not finish.
"""

import argparse
import concurrent.futures
import shutil
import sys
import threading
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display is needed

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import gallery_exact  # noqa: E402
import gallery_page  # noqa: E402
import gallery_scenes  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from verdict import Verdicts  # noqa: E402

COMMITTED_FIGURES = folders.FIGURES
ENTRIES = [*gallery_scenes.ENTRIES, *gallery_exact.ENTRIES]


class Progress:
    """Says what has been solved, since when."""

    def __init__(self):
        self.start, self.lock = time.monotonic(), threading.Lock()

    def report(self, label, run, seconds):
        spent = "kept" if seconds is None else f"{seconds:.0f} s"
        steps = f"{len(run.steps):>4} steps  {run.newton_iterations:>5} Newton iterations" if run.summary else ""
        self.say(f"  {label:<32} {steps:<40} {spent:>7}")

    def say(self, text):
        with self.lock:
            minutes, seconds = divmod(int(time.monotonic() - self.start), 60)
            print(f"[{minutes:3d}:{seconds:02d}] {text}", flush=True)


def solve(entry, driver):
    """(verdicts, what the entry's figures need, what went wrong). Runs in a thread: the work is in other processes."""
    verdicts = Verdicts()
    try:
        return verdicts, entry.solve(verdicts, driver), None
    except (SceneError, KeyError, ValueError, OSError) as problem:
        verdicts.failed(f"{entry.name}: stopped", f"{type(problem).__name__}: {problem}")
        return verdicts, None, problem


def gallery(build, jobs, only, renew_figures):
    output, progress = build / "gallery", Progress()
    driver = Driver(build, output, keep=True, report=progress.report)
    entries = [entry for entry in ENTRIES if not only or entry.name in only]
    progress.say(
        f"{len(entries)} entries; on one core about {sum(entry.minutes for entry in entries):.0f} minutes, "
        f"with {jobs} at a time not less than {max(entry.minutes for entry in entries):.0f}"
    )
    pages, passed = [], True
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        longest_first = sorted(entries, key=lambda entry: -entry.minutes)
        running = {pool.submit(solve, entry, driver): entry for entry in longest_first}
        for future in concurrent.futures.as_completed(running):
            entry = running[future]
            verdicts, solved, problem = future.result()
            drawn = []
            if problem is None:
                drawn = entry.draw(solved, output)
                if renew_figures:
                    for path in drawn:
                        if path.name in entry.committed:
                            shutil.copy(path, COMMITTED_FIGURES / path.name)
            verdicts.write(output / f"{entry.name}.json")
            done = sum(f.done() for f in running)
            state = "ok" if verdicts.passed else "FAILED"
            progress.say(f"{entry.name}: {state}; {len(drawn)} figures; {done} of {len(entries)} entries done")
            if not verdicts.passed:
                verdicts.print()
            passed = passed and verdicts.passed
            pages.append((ENTRIES.index(entry), entry, verdicts, drawn))
    pages.sort(key=lambda page: page[0])
    index = gallery_page.write(output / ("some.html" if only else "index.html"), [page[1:] for page in pages])
    progress.say(f"written: {index.resolve()}")
    return passed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--jobs", type=int, default=1, help="scenes solved at the same time")
    parser.add_argument("--only", nargs="+", choices=[entry.name for entry in ENTRIES], help="these entries alone")
    parser.add_argument("--renew-figures", action="store_true", help="renew the committed figures too")
    arguments = parser.parse_args()
    return 0 if gallery(arguments.build, arguments.jobs, arguments.only, arguments.renew_figures) else 1


if __name__ == "__main__":
    sys.exit(main())
