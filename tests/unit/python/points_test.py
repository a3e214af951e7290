"""Worlds of points and the odometry on them."""
import os
import pathlib
import unittest

import numpy as np

import vobench

SOURCE = pathlib.Path(os.environ["VOBENCH_SOURCE_DIR"])


class Points(unittest.TestCase):
    def setUp(self):
        self.scenario = vobench.Scenario(SOURCE / "scenes/points.yaml", {"time.duration": "0.5 s", "world.points.measurement.noise": "1e-6 px"})

    def test_frames_show_the_landmarks(self):
        world = vobench.PointWorld(self.scenario, seed=5)
        self.assertEqual((world.seed, len(world)), (5, 15))
        frames = list(world)
        frame = frames[-1]
        self.assertEqual(frame.ids.strides, frame.pixels.strides[:1])  # views of one list
        self.assertTrue((np.diff(frame.ids) > 0).all())
        X_W, T = world.landmarks[frame.ids], frame.truth.T_WC
        X_C = (X_W[:, :3] - X_W[:, 3:] * frame.truth.p_WC) @ T[:3, :3]
        np.testing.assert_allclose(world.camera.project(X_C), frame.pixels, atol=1e-5)
        self.assertIsNone(next(world, None))  # plays once

    def test_worlds_are_functions_of_their_seed(self):
        a, b, c = (next(vobench.PointWorld(self.scenario, seed=seed)).pixels for seed in (1, 1, 2))
        np.testing.assert_array_equal(a, b)
        self.assertFalse(np.array_equal(a, c))

    def test_odometry_measurement_by_measurement(self):
        world = vobench.PointWorld(self.scenario, seed=2)
        odometry = vobench.PointOdometry.of(world, "rb2pf")
        for frame in world:
            estimate = odometry.track(frame.stamp_ns, frame.ids, frame.pixels)
        self.assertLess(np.linalg.norm(estimate.p_WC - frame.truth.p_WC), 0.2)
        weight, p, q, velocity, covariance = odometry.particles()
        self.assertAlmostEqual(weight.sum(), 1, places=12)
        self.assertEqual((p.shape[1], q.shape[1], velocity.shape[1], covariance.shape[1:]), (3, 4, 6, (12, 12)))
        np.testing.assert_allclose(weight @ p, estimate.p_WC, atol=1e-12)
        spread = covariance[:, 6:, 6:] + np.einsum("ni,nj->nij", *2 * [velocity - weight @ velocity])
        np.testing.assert_allclose(np.einsum("n,nij->ij", weight, spread), estimate.covariance[6:, 6:], rtol=1e-6, atol=1e-12)

    def test_a_point_is_seen_once_in_a_frame(self):
        world = vobench.PointWorld(self.scenario, seed=2)
        odometry = vobench.PointOdometry.of(world, "rb2pf")
        frame = next(world)
        odometry.track(frame.stamp_ns, frame.ids, frame.pixels)
        twice = np.repeat(frame.ids[:1], 2), np.repeat(frame.pixels[:1], 2, axis=0)
        with self.assertRaisesRegex(ValueError, r"point \d+ comes twice in the frame at \d+ ns"):
            odometry.track(frame.stamp_ns + 33_333_333, *twice)

    def test_plays_to_any_filter(self):
        seen = []

        class Still:
            def track(self, stamp_ns, ids, pixels):
                seen.append((stamp_ns, len(ids), pixels.shape))
                return vobench.Estimate(covariance=np.eye(12), p_WC=[1, 2, 3])
        run = vobench.play(vobench.PointWorld(self.scenario), Still())
        self.assertEqual(len(seen), 15)
        self.assertEqual(seen[3][2], (seen[3][1], 2))
        np.testing.assert_allclose(run.errors[:, :3], run.truth.positions - [1, 2, 3])
        np.testing.assert_allclose(run.nees["position"], (run.errors[:, :3] ** 2).sum(axis=1), rtol=1e-12)
        self.assertEqual(list(run.nees), ["position", "orientation", "linear velocity", "angular velocity", "pose", "velocity", "joint"])
        np.testing.assert_array_equal(run.sigmas, np.ones((15, 12)))

    def test_says_what_is_wrong(self):
        odometry = vobench.PointOdometry(vobench.Camera())
        with self.assertRaisesRegex(ValueError, "2 ids, but 3 pixels"):
            odometry.track(0, [1, 2], np.zeros((3, 2)))
        with self.assertRaisesRegex(ValueError, "is not a unit one: its norm is"):
            vobench.Estimate(covariance=np.eye(12), q_WC=[0, 0, 0, 2])
        with self.assertRaisesRegex(ValueError, "meshes, not points"):
            vobench.PointWorld(vobench.Scenario(SOURCE / "scenes/tiny.yaml"))


if __name__ == "__main__":
    unittest.main()
