"""torch_network.py: a network trained in PyTorch, as a model file, evaluated by libhnbrdf.

    python3 examples/python/torch_network.py trained.safetensors

The file is safetensors with the tensors and the metadata of "Model files" in src/README.md; the
package of that name is not needed. hnbrdf.fit() trains better: this is for losses and data of your
own.
"""
from __future__ import annotations

import json
import struct
import sys

import numpy as np

import hnbrdf
from numpy_network import directions

try:
    import torch
except ImportError:
    sys.exit("torch_network.py: needs PyTorch")

FLOOR = 0.003  # b


class HardGELU(torch.nn.Module):
    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return x * torch.clamp(x / 3 + 0.5, 0, 1)


def make_network(hidden: int) -> torch.nn.Sequential:
    """wi and wo to (c, g): the encoding `directions`, no latent code."""
    return torch.nn.Sequential(torch.nn.Linear(6, hidden), HardGELU(),
                               torch.nn.Linear(hidden, hidden), HardGELU(),
                               torch.nn.Linear(hidden, 6))


def f_of(network: torch.nn.Module, x: torch.Tensor, f_a: torch.Tensor) -> torch.Tensor:
    out = network(x)
    return torch.clamp(torch.exp(out[:, :3]) + torch.sigmoid(out[:, 3:]) * f_a - FLOOR, min=0)


def save(path: str, network: torch.nn.Sequential, name: str, material: np.void) -> None:
    """A model file with one material: eight bytes of length, a JSON header, then the numbers."""
    layers = [layer for layer in network if isinstance(layer, torch.nn.Linear)]
    tensors = {f"net.{k}.{part}": getattr(layer, part).detach().numpy()
               for k, layer in enumerate(layers) for part in ("weight", "bias")}
    for field in "kd", "eta", "alpha", "rotation":
        tensors["material." + field] = material[field][None]
    tensors["material.latent"] = np.zeros((1, 0))
    header = {"__metadata__": {"format": "hnbrdf/1", "kind": "hybrid", "encoding": "directions",
                               "materials": json.dumps([name]), "floor": str(FLOOR)}}
    data = b""
    for key, tensor in tensors.items():
        numbers = np.ascontiguousarray(tensor, "<f4").tobytes()
        header[key] = {"dtype": "F32", "shape": list(tensor.shape),
                       "data_offsets": [len(data), len(data) + len(numbers)]}
        data += numbers
    text = json.dumps(header).encode()
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


def main(path: str, steps: int = 400) -> float:
    torch.manual_seed(1)
    name = "velvet-crimson"
    measured = hnbrdf.Measured.builtin(name)
    ggx, _ = hnbrdf.fit(measured, kind="ggx", pool=8192)
    wi, wo = directions(8192, 1), directions(8192, 2)
    x = torch.from_numpy(np.concatenate([wi, wo], -1))
    f_a = torch.from_numpy(ggx.evaluate_analytic(wi, wo, name))
    target = torch.from_numpy(measured.evaluate(wi, wo))

    network = make_network(16)
    optimiser = torch.optim.Adam(network.parameters(), 1e-2)
    for step in range(steps):
        f = f_of(network, x, f_a)
        loss = (2 * (f - target).abs() / (f + target + 1e-4)).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    print(f"SMAPE {loss.item():.3f}")

    save(path, network, name, ggx[name])
    model = hnbrdf.Model.load(path)
    with torch.no_grad():
        theirs = f_of(network.double(), x.double(), f_a.double()).numpy()
    difference = (np.abs(model.evaluate(wi, wo, name) - theirs) / np.maximum(1, theirs)).max()
    print(f"PyTorch and libhnbrdf differ by {difference:.1e}")
    return float(difference)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: torch_network.py OUT.safetensors")
    main(sys.argv[1])
