"""fitting: models of measurements, and how far they are from them."""
from __future__ import annotations

import ctypes as c
import os
from typing import Any, Callable, NamedTuple, Optional, Sequence, Union

from .layouts import _P, _comparison, _fit_fn, _fit_options, _fit_progress, _fit_report, value_of
from .library import call, dictionary, part
from .measured import Measured
from .models import Model


class Progress(NamedTuple):
    """hnbrdf_fit_progress: stage is sampling, ggx, network or lobes, done its share from 0 to 1."""
    stage: str
    done: float
    loss: float
    pairs_per_s: float
    seconds_left: float
    step: int


def fit(data: Union[Measured, Sequence[Measured]], *, kind: str = "hybrid", net: str = "32x2",
        latent: Optional[int] = None, encoding: Optional[str] = None, floor: Optional[float] = None,
        analytic: str = "faithful", loss: str = "log-to-smape", schedule: str = "cosine",
        freeze: Optional[Model] = None, checkpoint: Union[str, os.PathLike, None] = None,
        resume: bool = False, progress: Optional[Callable[[Progress], Any]] = None,
        **numbers: Any) -> tuple[Model, dict[str, Any]]:
    """One model of all these materials, and hnbrdf_fit_report as a dict.

    numbers: steps, seconds, batch, pool, learning_rate, horizon_share, bright_share, uniform_share,
    lift, seed and threads, as in hnbrdf_fit_options; what is left out is the default of the library. latent=0
    and floor=0 ask for none. progress is called ten times a second; when it returns something true, or Ctrl-C is
    pressed, training ends (the latter raises KeyboardInterrupt). Bits depend on data, options and
    seed alone."""
    data = [data] if isinstance(data, Measured) else list(data)
    allowed = {"steps", "seconds", "batch", "pool", "learning_rate", "horizon_share",
               "bright_share", "uniform_share", "lift", "seed", "threads"}
    if set(numbers) - allowed:
        raise TypeError(f"no option {', '.join(sorted(set(numbers) - allowed))}, expected one of "
                        f"{', '.join(sorted(allowed))}")
    hidden, _, layers = net.partition("x")
    if not (hidden.isdigit() and layers.isdigit()):
        raise ValueError(f"net {net!r}: expected HxN, as in 32x2")
    caught: list[BaseException] = []

    def told(_user: Any, address: int) -> int:
        try:
            if progress is None:
                return any(item._caught for item in data)
            p = _fit_progress.from_address(address)
            stop = progress(Progress(p.stage.decode(), p.done, p.loss, p.pairs_per_s,
                                     p.seconds_left, p.step))
            return bool(stop) or any(item._caught for item in data)
        except BaseException as error:  # Ctrl-C too: raised again below
            caught.append(error)
            return 1

    sized = freeze is None and kind != "ggx"
    options = _fit_options(
        kind=value_of("kind", kind), hidden=int(hidden) if sized else 0,
        layers=int(layers) if sized else 0, latent=latent or 0, latent_none=latent == 0,
        encoding=None if encoding is None else encoding.encode(), floor=floor or 0,
        floor_none=floor == 0, analytic=value_of("analytic", analytic), loss=value_of("loss", loss),
        schedule=value_of("schedule", schedule), progress=_fit_fn(told),
        freeze=None if freeze is None else freeze._as_parameter_._as_parameter_,
        checkpoint=None if checkpoint is None else os.fsencode(checkpoint), resume=resume,
        **numbers)
    array = (_P * len(data))(*(item._as_parameter_._as_parameter_ for item in data))
    report, pointer = _fit_report(), _P()
    try:
        call(part("hnbrdf_fit").fit, array, len(data), c.byref(options), c.byref(pointer),
              c.byref(report))
    finally:
        for item in data:
            caught += item._caught
            item._caught.clear()
        if caught:
            raise caught[0]
    return Model(pointer.value), dictionary(report)


def compare(model: Model, material: Any, measured: Measured, sampler: str = "uniform",
            pairs: int = 100000, seed: int = 1) -> dict[str, Any]:
    """Errors against a measurement, hnbrdf_comparison as a dict: smape (0 to 2), smape_analytic (of
    GGX alone), mae and mse over pairs of directions that the sampler draws."""
    result, chosen = _comparison(), model._one(material)
    call(part("hnbrdf_metrics").compare, model, chosen.ctypes.data, measured,
          value_of("sampler", sampler), pairs, seed, c.byref(result))
    return dictionary(result)
