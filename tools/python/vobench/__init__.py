"""Synthetic data for visual odometry, and the bench that tests it: docs/python.md."""
from vobench._core import (
    SETTINGS, SYSTEMS, AneesVerdict, Ate, Camera, Check, Diagnostics, Estimate, Frame, ImageFrame, InputError, LinearFilter, NumericalEvents, Odometry,
    PointFrame, PointOdometry, PointWorld, Prior, Rpe, Run, Scenario, SceneError, Sequence, SettingsError, Simulator, Statistics,
    Trajectory, Truth, Verdict, __version__, anees_test, anees_test_against, ate, chi2_band, judge, nees, play, rpe, test_consistency)

__all__ = [
    "SETTINGS", "SYSTEMS", "AneesVerdict", "Ate", "Camera", "Check", "Diagnostics", "Estimate", "Frame", "ImageFrame", "InputError",
    "LinearFilter", "NumericalEvents", "Odometry", "PointFrame", "PointOdometry", "PointWorld", "Prior", "Rpe", "Run", "Scenario", "SceneError",
    "Sequence", "SettingsError", "Simulator", "Statistics", "Trajectory", "Truth", "Verdict", "__version__", "anees_test",
    "anees_test_against", "ate", "chi2_band", "judge", "nees", "play", "rpe", "test_consistency"]

for _thing in map(globals().get, __all__):  # what users see is vobench.Scenario, not vobench._core.Scenario
    if isinstance(_thing, type):
        _thing.__module__ = "vobench"
