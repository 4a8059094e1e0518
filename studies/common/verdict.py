"""Compare computed figures with references, print the table, write it as JSON."""

import json
import math
import time
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass
class Row:
    """One comparison. It passes when error <= bound; an error that is not a number fails."""

    quantity: str
    computed: float
    reference: float | None
    error: float
    bound: float
    reason: str

    @property
    def passed(self):
        return bool(math.isfinite(self.error) and self.error <= self.bound)


class Verdicts:
    """`progress`: where each comparison is told at once, with the seconds since the first, as long groups take minutes; None: nowhere."""

    def __init__(self, progress=None):
        self.rows, self.progress, self.start = [], progress, time.monotonic()

    def near(self, quantity, computed, reference, bound, reason, scale=None):
        """|computed - reference| relative to `scale` (default: the reference) must not exceed `bound`."""
        computed, reference = float(computed), float(reference)
        error = abs(computed - reference) / abs(reference if scale is None else scale)
        self._add(Row(quantity, computed, reference, error, bound, reason))

    def below(self, quantity, value, bound, reason):
        """A figure whose ideal is zero must not exceed `bound`."""
        self._add(Row(quantity, float(value), None, float(value), bound, reason))

    def at_least(self, quantity, value, least, reason):
        """A figure must reach `least`; the error is what is missing."""
        value = float(value)
        self._add(
            Row(quantity, value, least, max(0.0, least - value) if math.isfinite(value) else math.nan, 0.0, reason)
        )

    def within(self, quantity, value, low, high, reason):
        """A figure must lie between two others; the error is how far it is outside."""
        value = float(value)
        outside = max(low - value, value - high, 0.0) if math.isfinite(value) else math.nan
        self._add(Row(f"{quantity} ({low:.4g} to {high:.4g})", value, None, outside, 0.0, reason))

    def true(self, quantity, holds, reason):
        """A statement that either holds or does not."""
        self._add(Row(quantity, float(bool(holds)), 1.0, 0.0 if holds else 1.0, 0.0, reason))

    def failed(self, quantity, reason):
        self._add(Row(quantity, math.nan, None, math.inf, 0.0, reason))

    def _add(self, row):
        self.rows.append(row)
        if self.progress:
            seconds, verdict = time.monotonic() - self.start, "ok" if row.passed else "FAILED"
            print(f"[{seconds:5.0f} s] {verdict:<6} {row.quantity}", file=self.progress, flush=True)

    @property
    def passed(self):
        """Nothing compared is not a pass."""
        return bool(self.rows) and all(row.passed for row in self.rows)

    def print(self, with_reasons=False):
        width = max([len(row.quantity) for row in self.rows] + [8])
        print(f"{'quantity':<{width}}  {'computed':>12}  {'reference':>12}  {'error':>9}  {'bound':>9}  verdict")
        for row in self.rows:
            reference = "" if row.reference is None else f"{row.reference:.7g}"
            verdict = "ok" if row.passed else "FAILED"
            print(
                f"{row.quantity:<{width}}  {row.computed:>12.7g}  {reference:>12}  {row.error:>9.2e}  {row.bound:>9.2g}  {verdict}"
            )
            if with_reasons or not row.passed:
                print(f"{'':<{width}}  ({row.reason})")

    def write(self, path):
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        # JSON has no infinity: a missing number is null
        clean = lambda value: None if isinstance(value, float) and not math.isfinite(value) else value
        rows = [
            {**{key: clean(value) for key, value in asdict(row).items()}, "passed": row.passed} for row in self.rows
        ]
        path.write_text(json.dumps({"passed": self.passed, "rows": rows}, indent=1) + "\n")
