"""A consistency test of one's own filter, as docs/python.md has it, and that it tells right from wrong."""
import os
import pathlib
import unittest

import numpy as np

import vobench

SOURCE = pathlib.Path(os.environ["VOBENCH_SOURCE_DIR"])
# Half a second with 20 points: an honest filter is rejected in at most 1.6 % of tests with fresh seeds.
SETTINGS = {"time.duration": "0.5 s", "world.points.count": 20}


def scenario(**more):
    return vobench.Scenario(SOURCE / "scenes/points.yaml", {**SETTINGS, **more})


class Filter:
    """EKF-SLAM, its covariance times a factor."""
    factor = 1.0

    def __init__(self, world):
        self.ekf = vobench.PointOdometry.of(world, "ekfslam")

    def track(self, stamp_ns, ids, pixels):
        estimate = self.ekf.track(stamp_ns, ids, pixels)
        estimate.covariance = self.factor * estimate.covariance
        return estimate


class Bold(Filter):
    factor = 0.5


class Timid(Filter):
    factor = 2.0


class TestConsistency(unittest.TestCase):
    def test_passes_a_filter_that_is_exact(self):
        verdict = vobench.test_consistency(scenario(), Filter)
        self.assertTrue(verdict, verdict)
        self.assertAlmostEqual(verdict.false_alarm, 0.016)

    def test_rejects_half_and_twice_the_covariance(self):
        for wrong in Bold, Timid:
            verdict = vobench.test_consistency(scenario(), wrong)
            self.assertFalse(verdict)
            self.assertIn("ANEES mean, joint", repr(verdict))
        self.assertIn("not >= ", repr(verdict))

    def test_what_goes_wrong_in_the_filter_comes_out_as_it_is(self):
        class Broken:
            def track(self, *_):
                raise KeyError("mine")

        class Silent:
            def track(self, *_):
                return None
        with self.assertRaisesRegex(KeyError, "mine"):
            vobench.test_consistency(scenario(), lambda world: Broken())
        with self.assertRaisesRegex(TypeError, "must return a vobench.Estimate, not .*NoneType"):
            vobench.test_consistency(scenario(), lambda world: Silent())
        with self.assertRaisesRegex(AttributeError, "track"):
            vobench.test_consistency(scenario(), lambda world: 3)
        with self.assertRaisesRegex(ValueError, "runs = 3 must be 10 or more"):
            vobench.test_consistency(scenario(), Filter, runs=3)


def kalman(claimed, runs=60, frames=90, dt=0.1, psd=0.25, sigma=0.5, seed=1):
    """NEES of a Kalman filter of a nearly constant velocity per axis, position measured: written out here, so that it shares nothing with
    the reference. It claims the motion's noise times a factor."""
    rng = np.random.default_rng(seed)
    F = np.array([[1, dt], [0, 1]])
    Q = psd * np.array([[dt ** 3 / 3, dt ** 2 / 2], [dt ** 2 / 2, dt]])
    P = np.diag([sigma ** 2, 1.0])
    for _ in range(1000):  # to its steady state
        P = F @ P @ F.T + claimed * Q
        K = P[:, :1] / (P[0, 0] + sigma ** 2)
        P = P - K @ P[:1]
    errors, covariances = np.empty((runs, frames, 3)), np.empty((runs, frames, 3, 3))
    error = np.linalg.cholesky(P) @ rng.standard_normal((runs, 2, 3))
    for frame in range(frames):
        error = F @ error + np.linalg.cholesky(Q) @ rng.standard_normal((runs, 2, 3))
        error = error - K @ (error[:, :1] + sigma * rng.standard_normal((runs, 1, 3)))
        errors[:, frame], covariances[:, frame] = error[:, 0], P[0, 0] * np.eye(3)
    return vobench.nees(errors, covariances), vobench.LinearFilter(dt=dt, psd=psd, sigma_position=float(np.sqrt(P[0, 0])))


class AneesTest(unittest.TestCase):
    def test_passes_a_kalman_filter(self):  # share and mean: a false alarm in at most 0.2 % of fresh seeds
        nees, reference = kalman(1)
        self.assertAlmostEqual(reference.measurement_sigma, 0.5, delta=1e-6)
        verdict = vobench.anees_test(nees, reference, false_alarm=0.001)
        self.assertTrue(verdict, verdict)
        self.assertEqual(verdict.passed, bool(verdict))

    def test_rejects_half_the_covariance_and_noise_that_it_does_not_know(self):
        nees, reference = kalman(1)
        for wrong in 2 * nees, nees / 2, kalman(0.1)[0]:
            verdict = vobench.anees_test(wrong, reference, false_alarm=0.001)
            self.assertFalse(verdict, verdict)
            self.assertTrue(repr(verdict).startswith("not consistent: ANEES / dof "))

    def test_holds_against_consistent_runs_of_ones_own(self):
        reference, _ = kalman(1, runs=600, seed=2)
        self.assertTrue(vobench.anees_test_against(kalman(1)[0], 3, reference, false_alarm=0.001))
        self.assertFalse(vobench.anees_test_against(2 * kalman(1)[0], 3, reference, false_alarm=0.001))

    def test_says_what_is_wrong_with_its_arrays(self):
        with self.assertRaisesRegex(ValueError, r"errors must be \(..., n\) and covariances \(..., n, n\)"):
            vobench.nees(np.zeros((4, 3)), np.zeros((4, 3, 2)))
        with self.assertRaisesRegex(ValueError, r"nees must be \(runs, frames\)"):
            vobench.anees_test(np.ones(5))
        with self.assertRaisesRegex(ValueError, "nees and reference must have equally many frames"):
            vobench.anees_test_against(np.ones((5, 5)), 3, np.ones((50, 4)))
        with self.assertRaisesRegex(ValueError, "false_alarm must be above 0"):
            vobench.anees_test(np.ones((5, 5)), false_alarm=0)


class Nees(unittest.TestCase):
    def test_is_the_quadratic_form(self):
        rng = np.random.default_rng(3)
        A = rng.standard_normal((4, 5, 3, 3))
        P = A @ A.swapaxes(-1, -2) + np.eye(3)
        e = rng.standard_normal((4, 5, 3))
        np.testing.assert_allclose(vobench.nees(e, P), np.einsum("...i,...ij,...j", e, np.linalg.inv(P), e), rtol=1e-10)
        self.assertTrue(np.isnan(vobench.nees([1.0, 1.0], np.zeros((2, 2)))))

    def test_band(self):
        low, high = vobench.chi2_band(3, runs=50)
        np.testing.assert_allclose([low, high], [117.985 / 50, 185.800 / 50], rtol=1e-5)  # tables of chi-square, 150 degrees


if __name__ == "__main__":
    unittest.main()
