# SPDX-License-Identifier: BSD-3-Clause
"""Pictures by matplotlib, where it is installed."""

from . import _core
from .errors import optional


def plot_trajectories(trajectories, axes=None):
    """Draws {name: aims.Trajectory} from above, x to the right and y up [m]; returns the axes."""
    if axes is None:
        pyplot = optional("matplotlib.pyplot", "python3-matplotlib", "plot_trajectories()")
        axes = pyplot.figure(layout="constrained").add_subplot()
    styles = dict(zip(trajectories, _core.line_styles([str(name) for name in trajectories])))
    for name, trajectory in trajectories.items():
        color, dashes = styles[name]
        style = {"color": color, "linewidth": 1.5, "dashes": dashes} if dashes else {"color": color}
        if name == "truth":
            style = {"color": "0.6", "linewidth": 4}
        axes.plot(trajectory.positions[:, 0], trajectory.positions[:, 1], label=name, **style)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend()
    return axes


def plot_series(result, names, axes=None):
    """Draws series of an Outcome or Estimator over time [s since its first scan]; returns the axes."""
    diagnostics = result.diagnostics
    names = [names] if isinstance(names, str) else list(names)
    if axes is None:
        pyplot = optional("matplotlib.pyplot", "python3-matplotlib", "plot_series()")
        axes = pyplot.figure(layout="constrained").add_subplot()
    seconds = 1e-9 * (diagnostics["stamp"] - diagnostics["stamp"][:1])
    for name in names:
        axes.plot(seconds, diagnostics[name], label=name)
    axes.set(xlabel="time [s]")
    axes.legend()
    return axes
