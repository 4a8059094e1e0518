"""The figure of docs/other_programs.md: the error of each program against facets."""

import matplotlib

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FormatStrFormatter  # noqa: E402

import exact_tests  # noqa: E402
from figures import BLUE, GREY, INK, RED, _save  # noqa: E402

OTHERS = dict(zip(exact_tests.PEERS, (GREY, "#c9b79c", "#8a6d4b", "#d0862c", "#e0b050", "#7d5aa6", "#b79ad0", "#9a6fb8", "#3a8f5c")))
COLOURS = {**dict(zip(exact_tests.OURS, (BLUE, RED))), **OTHERS}
# (test, its number, column)
SHOWN = (("wave", 0, 0), ("rounded", 0, 1), ("rounded", 1, 1), ("sliding", 1, 0))


def draw(drawn, path):
    figure, axes = plt.subplots(1, len(SHOWN), figsize=(17, 4.6))
    for axis, (name, number, column) in zip(axes, SHOWN):
        test = exact_tests.TESTS[name][number]
        for program, colour in COLOURS.items():
            of = [row for row in drawn[name] if (row.test, row.program) == (test.title, program) and row.errors]
            mine = program in exact_tests.OURS
            axis.loglog([row.facets for row in of], [row.mean(column) for row in of], "o-" if mine else "s--", color=colour,
                        markersize=4, linewidth=2 if mine else 1, zorder=3 if mine else 2, label=program)
        axis.set(title=test.title, xlabel="facets over the half-width", ylabel=f"error of {test.columns[column]} [%]")
        axis.set_xticks(test.facets, [str(n) for n in test.facets])
        axis.set_xticks([], minor=True)
        axis.yaxis.set_major_formatter(FormatStrFormatter("%g"))
        axis.yaxis.set_minor_formatter(FormatStrFormatter("%g"))
        axis.grid(True, which="major", color="#eeeeee", zorder=0)
        axis.tick_params(colors=INK)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncol=4, frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0.14, 1, 1))
    return _save(figure, path)
