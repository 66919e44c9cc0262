"""numpy_network.py: weights out to NumPy and in again.

    python3 examples/python/numpy_network.py pruned.safetensors

Fits a small model, evaluates its network in NumPy as "Model files" in src/README.md has it, and
makes a model of it with a tenth of the weights set to 0.
"""
from __future__ import annotations

import dataclasses
import sys

import numpy as np

import hnbrdf


def directions(count: int, seed: int) -> hnbrdf.Array:
    """Uniform over the hemisphere, [count, 3], float32."""
    random = np.random.default_rng(seed)
    z, phi = random.random(count) * 0.98 + 0.01, random.random(count) * 2 * np.pi
    across = np.sqrt(1 - z * z)
    return np.stack([across * np.cos(phi), across * np.sin(phi), z], -1).astype(np.float32)


def network(d: hnbrdf.Description, latent: np.ndarray, wi: np.ndarray, wo: np.ndarray
            ) -> np.ndarray:
    """(c, g) of the encoding `directions`, [N, 6], in double precision."""
    x = np.concatenate([wi, wo, np.broadcast_to(latent[:d.latent], (len(wi), d.latent))], -1)
    for k, (weight, bias) in enumerate(zip(d.weights, d.biases)):
        x = x @ np.asarray(weight, np.float64).T + np.asarray(bias, np.float64)
        if k < len(d.weights) - 1:
            x *= np.clip(x / 3 + 0.5, 0, 1)  # HardGELU
    return x


def evaluate(model: hnbrdf.Model, name: str, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """f of an unedited material, max(0, exp(s c + m) + sigmoid(g) f_a - b), [N, 3]."""
    d = model.describe()
    out = network(d, model[name]["latent"], wi, wo)
    f_a = model.evaluate_analytic(wi, wo, name)
    f = np.exp(d.scale * out[:, :3] + d.shift) + f_a / (1 + np.exp(-out[:, 3:])) - d.floor
    return np.maximum(f, 0)


def main() -> None:
    data = [hnbrdf.Measured.builtin(name) for name in ("rough-clay", "velvet-crimson")]
    model, report = hnbrdf.fit(data, net="16x2", encoding="directions", steps=300, pool=8192)
    wi, wo = directions(10000, 1), directions(10000, 2)

    ours, theirs = evaluate(model, "velvet-crimson", wi, wo), model.evaluate(
        wi, wo, "velvet-crimson")
    difference = (np.abs(ours - theirs) / np.maximum(1, ours)).max()
    print(f"NumPy and libhnbrdf differ by {difference:.1e}")

    d = model.describe()
    cut = np.quantile(np.abs(np.concatenate([np.ravel(weight) for weight in d.weights])), 0.1)
    weights = [np.where(np.abs(weight) < cut, 0, weight) for weight in d.weights]
    pruned = hnbrdf.Model.create(dataclasses.replace(d, weights=weights))
    for name, measured in zip(model.names, data):
        errors = [hnbrdf.compare(made, name, measured, pairs=10000)["smape"]
                  for made in (model, pruned)]
        print("{}: SMAPE {:.3f}, pruned {:.3f}".format(name, *errors))
    pruned.save(sys.argv[1])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: numpy_network.py OUT.safetensors")
    main()
