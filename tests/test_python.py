"""test_python.py SOURCE SCRATCH: what examples/python/hnbrdf gives, against the golden values of C and against itself;
run by test_python.sh."""
import dataclasses
import gc
import json
import pathlib
import struct
import sys
import threading
import unittest
import warnings

import numpy as np

import hnbrdf
from hnbrdf import Change, Measured, Model
from numpy_network import directions

SOURCE, SCRATCH = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SHIPPED, NAME = SOURCE / "examples/models/rgl_32x2.safetensors", "vch_silk_blue"
COUNT = 300
# The pairs of tests/test_golden.c.
PAIRS = np.array([
    [[0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]], [[0.28, 0.0, 0.96], [-0.28, 0.0, 0.96]],
    [[0.36, 0.48, 0.8], [-0.36, -0.48, 0.8]], [[0.0, 0.6, 0.8], [0.0, 0.28, 0.96]],
    [[0.8, 0.59999, 0.0044721], [-0.64, -0.48, 0.6]], [[0.0, 0.6, -0.8], [0.0, 0.0, 1.0]]], np.float32)


def formula(wi, wo):
    """Reciprocal and isotropic, [N, 3] to [N, 3]."""
    return np.stack([0.1 + 0.2 * wi[:, 2] * wo[:, 2], 0.3 + 0 * wi[:, 2], 0.2 + 0.1 * (wi * wo).sum(1)], -1)


class Values(unittest.TestCase):
    def setUp(self):
        self.model = Model.load(SHIPPED)
        self.wi, self.wo, self.u = directions(COUNT, 1), directions(COUNT, 2), np.random.default_rng(3).random(
            (COUNT, 2), np.float32)
        self.f = self.model.evaluate(self.wi, self.wo, NAME)

    def test_bits_of_version_0_1(self):
        seen, model = 0, None
        for line in (SOURCE / "tests/data/golden_values.txt").read_text().splitlines():
            words = line.split()
            if line.startswith("file"):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    model = Model.load(SOURCE / "tests/data" / words[1])
                described = model.describe()
                net = f"{len(described.biases[0])}x{len(described.biases) - 1}" if described.biases else "0x0"
                encoding = described.encoding if described.biases else "none"
                self.assertEqual([described.kind, encoding, net, f"l={described.latent}"], words[2:6])
            if line.startswith("value"):
                material, (wi, wo) = model.names[int(words[1])], PAIRS[int(words[2])]
                found = np.concatenate([model.evaluate(wi, wo, material), model.evaluate_analytic(wi, wo, material)])
                self.assertEqual([f"{bits:08x}" for bits in found.view(np.uint32)], words[3:9], line)
                seen += 1
        self.assertGreater(seen, 100)

    def test_arrays_without_copies(self):
        hits = np.zeros(COUNT, [("wi", "f4", 3), ("pixel", "i4"), ("wo", "f4", 3), ("f", "f4", 3), ("pdf", "f4")])
        hits["wi"], hits["wo"] = self.wi, self.wo
        f = hits["f"]
        self.assertIs(self.model.evaluate(hits["wi"], hits["wo"], NAME, out=f), f)
        np.testing.assert_array_equal(hits["f"], self.f)
        np.testing.assert_array_equal(hits["pixel"], 0)
        self.model.pdf(hits["wi"], hits["wo"], NAME, out=hits["pdf"])
        np.testing.assert_array_equal(hits["pdf"], self.model.pdf(self.wi, self.wo, NAME))
        rows = hnbrdf.arrays.input_rows(hits["wi"][::2], 3)
        self.assertTrue(np.shares_memory(rows, hits))
        np.testing.assert_array_equal(self.model.evaluate(self.wi[::2], self.wo[1::2], NAME),
                                      self.model.evaluate(self.wi[::2].copy(), self.wo[1::2].copy(), NAME))

    def test_arrays_of_any_kind(self):
        for wi, wo in ((self.wi[::-1][::-1], self.wo), (self.wi.astype(float), self.wo.astype(">f4")),
                       (np.asfortranarray(self.wi), self.wo), (self.wi.tolist(), self.wo)):
            np.testing.assert_array_equal(self.model.evaluate(wi, wo, NAME), self.f)
        grid = self.model.evaluate(self.wi.reshape(20, 15, 3), self.wo.reshape(20, 15, 3), NAME)
        np.testing.assert_array_equal(grid.reshape(-1, 3), self.f)
        np.testing.assert_array_equal(self.model.evaluate(self.wi[::-1], self.wo[::-1], NAME), self.f[::-1])
        one = self.model.evaluate(self.wi[None, :4], self.wo[:5, None], NAME)  # broadcast
        self.assertEqual(one.shape, (5, 4, 3))
        np.testing.assert_array_equal(one[2, 3], self.model.evaluate(self.wi[3], self.wo[2], NAME))
        self.assertEqual(self.model.evaluate(self.wi[:0], self.wo[:0], NAME).shape, (0, 3))

    def test_many_materials(self):
        index = np.arange(COUNT) * 7 % len(self.model)
        f = self.model.evaluate(self.wi, self.wo, index=index)
        pdf = self.model.pdf(self.wi, self.wo, index=index)
        samples = self.model.sample(self.wo, self.u, index=index)
        for k, name in enumerate(self.model.names):
            mine = index == k
            np.testing.assert_array_equal(f[mine], self.model.evaluate(self.wi[mine], self.wo[mine], name))
            np.testing.assert_array_equal(pdf[mine], self.model.pdf(self.wi[mine], self.wo[mine], name))
            alone = self.model.sample(self.wo[mine], self.u[mine], name)
            for part, whole in zip(alone, samples):
                np.testing.assert_array_equal(part, whole[mine])
        pair = ["vch_golden_yellow", NAME]
        np.testing.assert_array_equal(self.model.evaluate(self.wi, self.wo, pair, np.ones(COUNT, int)), self.f)
        own = self.model.materials[index]
        np.testing.assert_array_equal(self.model.evaluate(self.wi, self.wo, own), f)

    def test_samples(self):
        samples = self.model.sample(self.wo, self.u, NAME)
        drawn = samples.pdf > 0
        self.assertGreater(drawn.mean(), 0.9)
        np.testing.assert_array_equal(self.model.pdf(samples.wi, self.wo, NAME)[drawn], samples.pdf[drawn])
        wi, pdf = samples.wi[drawn], samples.pdf[drawn, None]
        weight = self.model.evaluate(wi, self.wo[drawn], NAME) * wi[:, 2:] / pdf
        np.testing.assert_allclose(samples.weight[drawn], weight, rtol=2**-22)  # three roundings

    def test_threads(self):
        out = [None] * 4

        def work(k):
            out[k] = self.model.evaluate(self.wi, self.wo, NAME)

        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for f in out:
            np.testing.assert_array_equal(f, self.f)

    def test_refusals(self):
        evaluate, wi, wo = self.model.evaluate, self.wi, self.wo
        for error, call in (
                (KeyError, lambda: evaluate(wi, wo, "nobody")), (ValueError, lambda: evaluate(wi[:, :2], wo, NAME)),
                (ValueError, lambda: evaluate(wi, wo[:7], NAME)), (ValueError, lambda: evaluate(wi, wo, NAME, out=wi)),
                (ValueError, lambda: evaluate(wi, wo, NAME, out=np.zeros((COUNT, 3)))),
                (IndexError, lambda: evaluate(wi, wo, index=np.full(COUNT, 12))),
                (IndexError, lambda: evaluate(wi, wo, index=np.full(COUNT, -1))),
                (TypeError, lambda: evaluate(wi, wo, index=np.zeros(COUNT))),
                (TypeError, lambda: evaluate(wi, wo, np.zeros(3))), (ValueError, lambda: evaluate(wi, wo)),
                (ValueError, lambda: self.model.sample(wo, wi, NAME)),
                (ValueError, lambda: Model.load(SHIPPED, variant="fast")),
                (ValueError, lambda: self.model.export_shader(weights="texture")),
                (TypeError, lambda: hnbrdf.fit(Measured.builtin("rough-clay"), epochs=3)),
                (ValueError, lambda: hnbrdf.fit(Measured.builtin("rough-clay"), net="32"))):
            self.assertRaises(error, call)
        with self.assertRaisesRegex(hnbrdf.Error, "missing.safetensors: cannot be opened") as caught:
            Model.load("missing.safetensors")
        self.assertEqual(caught.exception.result, hnbrdf.Result.IO)
        with self.assertRaisesRegex(hnbrdf.Error, "alpha"):
            hnbrdf.check(hnbrdf.material("alpha=3"))

    def test_views_outlive_the_model(self):
        described = self.model.describe()
        before = described.weights[0].copy()
        del self.model
        gc.collect()
        np.testing.assert_array_equal(described.weights[0], before)
        with self.assertRaises(ValueError):
            described.weights[0][0, 0] = 1


class Models(unittest.TestCase):
    def setUp(self):
        self.model = Model.load(SHIPPED)

    def test_weights_out_and_in(self):
        described = self.model.describe()
        again = Model.create(described)
        self.assertEqual(again.to_bytes(), self.model.to_bytes())
        self.assertEqual(Model.from_bytes(again.to_bytes()).to_bytes(), SHIPPED.read_bytes())
        again.save(SCRATCH / "again.safetensors")
        self.assertEqual((SCRATCH / "again.safetensors").read_bytes(), SHIPPED.read_bytes())
        for wrong in (dict(weights=described.weights[:2]), dict(weights=[w.T for w in described.weights]),
                      dict(latent=3), dict(names=described.names[1:]), dict(kind="neural")):
            self.assertRaises((ValueError, hnbrdf.Error), Model.create, dataclasses.replace(described, **wrong))
        nan = [np.full_like(bias, np.nan) for bias in described.biases]
        self.assertRaises(hnbrdf.Error, Model.create, dataclasses.replace(described, biases=nan))

    def test_edit(self):
        rough = hnbrdf.assign(self.model[NAME], "alpha*=2")
        self.assertTrue(hnbrdf.is_edited(rough) and not hnbrdf.is_edited(self.model[NAME]))
        by_hand = self.model[NAME]
        by_hand["alpha"] *= 2
        np.testing.assert_array_equal(by_hand["alpha"], rough["alpha"])
        edited = self.model.edit([Change("add", "rough", rough, lobes="guess"), Change("remove", "paper_white"),
                                  Change("rename", NAME, new_name="blue")])
        self.assertEqual(len(edited), 12)
        self.assertTrue("rough" in edited and "blue" in edited and "paper_white" not in edited)
        self.assertRaisesRegex(hnbrdf.Error, "nobody", self.model.edit, [Change("remove", "nobody")])
        wi, wo = directions(50, 1), directions(50, 2)
        np.testing.assert_array_equal(edited.evaluate(wi, wo, "rough"), self.model.evaluate(wi, wo, rough))
        np.testing.assert_array_equal(edited.evaluate(wi, wo, "blue"), self.model.evaluate(wi, wo, NAME))

    def test_mix(self):
        a, b = self.model[NAME], self.model["vch_golden_yellow"]
        self.assertEqual(hnbrdf.mix(a, b, 0), a)
        np.testing.assert_allclose(hnbrdf.mix(a, b, 0.5)["kd"], (a["kd"] + b["kd"]) / 2, rtol=1e-6)
        path = self.model.mix_path(NAME, b)
        self.assertEqual(hnbrdf.mix_at(path, 1), b)
        hnbrdf.check(hnbrdf.mix_at(path, 0.3))

    def test_export(self):
        text = self.model.export_shader([NAME], standalone=True)
        self.assertIn("HNBRDF_MATERIAL_VCH_SILK_BLUE", text)
        self.assertNotIn("PAPER_WHITE", text)
        self.assertIn("float3", self.model.export_shader([NAME], "hlsl", prefix="silk"))
        self.assertRaises(ValueError, self.model.export_shader, language="cobol")
        self.assertIn("hnbrdf_weights_block", self.model.export_shader(weights="uniform"))

    def test_notes(self):
        """A file in half precision is taken, with a warning."""
        data = SHIPPED.read_bytes()
        end = 8 + struct.unpack("<Q", data[:8])[0]
        header, numbers = json.loads(data[8:end]), b""
        for entry in header.values():
            if "dtype" in entry:
                begin, behind = entry["data_offsets"]
                half = np.frombuffer(data[end + begin:end + behind], "<f4").astype("<f2").tobytes()
                entry.update(dtype="F16", data_offsets=[len(numbers), len(numbers) + len(half)])
                numbers += half
        text = json.dumps(header).encode()
        with self.assertWarnsRegex(UserWarning, "F16"):
            model = Model.from_bytes(struct.pack("<Q", len(text)) + text + numbers)
        np.testing.assert_allclose(model.materials["eta"], self.model.materials["eta"], rtol=2**-11)


class Fits(unittest.TestCase):
    SMALL = dict(net="8x1", steps=60, pool=2048)

    def test_bits_and_progress(self):
        data, stages = [Measured.builtin(name) for name in ("rough-clay", "velvet-crimson")], []
        model, report = hnbrdf.fit(data, seed=3, progress=lambda p: stages.append(p.stage), **self.SMALL)
        again, _ = hnbrdf.fit(data, seed=3, threads=1, **self.SMALL)
        self.assertEqual(model.to_bytes(), again.to_bytes())
        self.assertEqual((model.names, report["steps"]), (("rough-clay", "velvet-crimson"), 60))
        self.assertTrue({"ggx", "network"} <= set(stages), stages)
        frozen, _ = hnbrdf.fit(Measured.builtin("gold-two-lobe"), freeze=model, steps=2, pool=64)
        self.assertEqual(frozen.names, ("gold-two-lobe", "rough-clay", "velvet-crimson"))

    def test_tables(self):
        wi, wo = directions(COUNT, 1), directions(COUNT, 2)
        table = Measured.tabulated("formula", formula)
        found = table.evaluate(wi, wo)
        valid = np.isfinite(found)
        self.assertGreater(valid.mean(), 0.97)
        # Linear between bins at most pi/2 (2 90 - 1)/90^2 rad wide, of something that curves by less than 1.
        np.testing.assert_allclose(found[valid], formula(wi, wo)[valid], atol=(np.pi / 2 * 179 / 8100) ** 2)
        self.assertEqual((table.name, table.isotropic), ("formula", True))

    def test_samples(self):
        wi, wo = directions(40000, 1), directions(40000, 2)
        f = formula(wi, wo)
        f[:100] = np.nan
        samples = Measured.samples("scattered", wi, wo, f, bins=(18, 18, 36))
        near, far = samples.evaluate(wi[200:500], wo[200:500]), formula(wi, wo)[200:500]
        self.assertTrue(np.isfinite(near).all())  # each lies in a bin that it filled itself
        self.assertLess(np.abs(near - far).mean(), 0.02)
        model, _ = hnbrdf.fit(samples, **self.SMALL)
        self.assertLess(hnbrdf.compare(model, "scattered", samples, pairs=2000)["smape"], 0.1)
        self.assertRaises(ValueError, Measured.samples, "x", wi, wo, f, bins=(7, 90, 180))

    def test_custom(self):
        custom = Measured.custom("own", lambda wi, wo: (wi[2] * wo[2], 0.2, 0.1) if wi[0] > -0.9 else None)
        np.testing.assert_allclose(custom.evaluate([0.6, 0, 0.8], [0, 0, 1]), [0.8, 0.2, 0.1], rtol=1e-6)
        self.assertTrue(np.isnan(custom.evaluate([-0.95, 0, 0.3122], [0, 0, 1])).all())
        model, _ = hnbrdf.fit(custom, kind="ggx", pool=256)
        self.assertEqual(model.describe().kind, "ggx")
        # What is raised in a callback stops the fit and comes out of it.
        for raised in ZeroDivisionError, KeyboardInterrupt:
            def broken(*_):
                raise raised("here")
            self.assertRaises(raised, hnbrdf.fit, Measured.custom("broken", broken), net="8x1", steps=2, pool=64)
            self.assertRaises(raised, hnbrdf.fit, custom, progress=broken, net="8x1", steps=2, pool=64)
        with self.assertRaises(hnbrdf.Error) as caught:
            hnbrdf.fit(custom, progress=lambda p: True, net="8x1", steps=2, pool=64)
        self.assertEqual(caught.exception.result, hnbrdf.Result.CANCELLED)

    def test_files(self):
        self.assertRaisesRegex(hnbrdf.Error, "nothing.binary: cannot be opened", Measured.open, "nothing.binary")
        self.assertRaises(TypeError, Measured.open, "x", merl=1)
        # MERL, by hand: 0.25 where theta_h is at least 22.5 degrees, nothing measured elsewhere.
        planes = np.full((3, 90, 90, 180), 0.25) / (np.array([1, 1.15, 1.66]) / 1500)[:, None, None, None]
        planes[:, :45] = -1
        merl = SCRATCH / "half.binary"
        merl.write_bytes(np.array([90, 90, 180], "<i4").tobytes() + planes.tobytes())
        table = np.full((90, 90, 180, 3), 0.25)
        table[:45] = np.nan
        for measured in Measured.open(merl, merl_lookup="trilinear"), Measured.table("half", table):
            found = measured.evaluate([[0, 0, 1], [0.8, 0, 0.6]], [[0, 0, 1], [0.6, 0, 0.8]])
            np.testing.assert_allclose(found, [[np.nan] * 3, [0.25] * 3], rtol=1e-6)
            self.assertEqual(measured.name, "half")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
