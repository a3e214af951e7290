"""Trajectories and their errors, against numpy."""
import pathlib
import tempfile
import unittest

import numpy as np

import vobench


def spiral(n=60):
    t = np.arange(n) * 0.1
    positions = np.column_stack([np.cos(t), np.sin(t), 0.1 * t])
    orientations = np.column_stack([0 * t, 0 * t, np.sin(t / 2), np.cos(t / 2)])
    return (t * 1e9).astype(np.int64), positions, orientations


class Trajectories(unittest.TestCase):
    def test_views_show_what_was_given(self):
        stamps, positions, orientations = spiral()
        trajectory = vobench.Trajectory(stamps, positions, orientations)
        np.testing.assert_array_equal(trajectory.stamps_ns, stamps)
        np.testing.assert_array_equal(trajectory.positions, positions)
        np.testing.assert_array_equal(trajectory.orientations, orientations)
        view = trajectory.positions
        del trajectory
        np.testing.assert_array_equal(view, positions)

    def test_files(self):
        trajectory = vobench.Trajectory(*spiral())
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "t.txt"
            trajectory.write(file)
            again = vobench.Trajectory.read(file)
            file.write_text("0 1 2 3 0 0 0 1\n1 x 2 3 0 0 0 1\n")
            with self.assertRaisesRegex(vobench.InputError, r"t.txt:2:3: .*x"):
                vobench.Trajectory.read(file)
        np.testing.assert_allclose(again.positions, trajectory.positions, atol=1e-11)
        self.assertAlmostEqual(again.path_length, np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1).sum(), places=9)

    def test_says_what_is_wrong(self):
        stamps, positions, orientations = spiral()
        with self.assertRaisesRegex(ValueError, r"stamps_ns\[1\] is not after"):
            vobench.Trajectory(0 * stamps, positions, orientations)
        with self.assertRaisesRegex(ValueError, "a trajectory of 60 stamps, 59 positions"):
            vobench.Trajectory(stamps, positions[1:], orientations)
        with self.assertRaisesRegex(ValueError, r"stamps_ns\[59\] is beyond 4e18"):
            vobench.Trajectory(np.append(stamps[:-1], 2 ** 62), positions, orientations)
        trajectory = vobench.Trajectory(stamps, positions, orientations)
        with self.assertRaisesRegex(ValueError, "gap_s = inf is not a time of 1e9 s at most"):
            vobench.ate(trajectory, trajectory, gap_s=float("inf"))
        with self.assertRaisesRegex(ValueError, "delta_s = 2000000000.0* is not a time"):
            vobench.rpe(trajectory, trajectory, delta_s=2e9)


class Errors(unittest.TestCase):
    def test_ate(self):
        stamps, positions, orientations = spiral()
        truth = vobench.Trajectory(stamps, positions, orientations)
        noise = 0.01 * np.random.default_rng(1).standard_normal(positions.shape)
        moved = vobench.Trajectory(stamps, 0.5 * (positions + noise) + [1, 2, 3], orientations)
        ate = vobench.ate(moved, truth)
        self.assertAlmostEqual(ate.scale, 2, delta=0.01)
        self.assertAlmostEqual(ate.position.rmse, np.sqrt((ate.position_errors ** 2).mean()), places=12)
        aligned = ate.scale * moved.positions @ ate.R.T + ate.t
        np.testing.assert_allclose(np.linalg.norm(aligned - positions, axis=1), ate.position_errors, atol=1e-12)
        self.assertGreater(vobench.ate(moved, truth, align="none").position.rmse, 3)
        with self.assertRaisesRegex(ValueError, "align = sim4 is none of none, se3, sim3, first, yaw"):
            vobench.ate(moved, truth, align="sim4")

    def test_rpe(self):
        stamps, positions, orientations = spiral()
        truth = vobench.Trajectory(stamps, positions, orientations)
        drifting = vobench.Trajectory(stamps, positions + np.outer(stamps / 1e9, [0, 0, 0.03]), orientations)
        rpe = vobench.rpe(drifting, truth)
        self.assertEqual(rpe.position.count, 50)
        np.testing.assert_allclose(rpe.position_errors, 0.03, rtol=1e-9)  # 3 cm a second
        np.testing.assert_allclose(rpe.orientation_errors, 0, atol=1e-7)

    def test_errors_where_nothing_fits(self):
        stamps, positions, orientations = spiral()
        with self.assertRaises(vobench.InputError):
            vobench.ate(vobench.Trajectory(stamps + 10 ** 12, positions, orientations), vobench.Trajectory(stamps, positions, orientations))


if __name__ == "__main__":
    unittest.main()
