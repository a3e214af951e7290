#!/usr/bin/env python3
"""Configuration files of Kalibr, OpenVINS, VINS-Fusion, ORB-SLAM3 and Basalt for a sequence in EuRoC's layout, ours or another's.

    python3 tools/python/examples/vio_configs.py SEQ [OUT]

reads SEQ/mav0/*/sensor.yaml and writes OUT, SEQ/configs by default; without an IMU those of VINS-Fusion, ORB-SLAM3 and Basalt alone. The texts are those of vio/*.in: @name@ is replaced, what is between
"@for A B@" and "@end@" is there for each of the cameras A ... B - 1. Densities of 0, which no filter takes, become those of EuRoC's IMU.
"""
import json
import pathlib
import re
import sys


def sensor(folder):
    """Numbers and lists of numbers of a sensor.yaml, by key; its words as they are."""
    text = (folder / "sensor.yaml").read_text()
    found = dict(re.findall(r"^\s*(\w+): *(\[[^\]]*\]|[^\s#]+)", text, re.M))
    return {key: json.loads(re.sub(r"\s", "", value)) if value[0] in "[-.0123456789" else value for key, value in found.items()}


def place(data):
    """Rotation, by rows, and translation of 16 numbers."""
    return [data[4 * i : 4 * i + 3] for i in range(3)], [data[4 * i + 3] for i in range(3)]


def from_to(a, b):
    """A^-1 B."""
    (Ra, pa), (Rb, pb) = a, b
    R = [[sum(Ra[k][i] * Rb[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return R, [sum(Ra[k][i] * (pb[k] - pa[k]) for k in range(3)) for i in range(3)]


def quaternion(R):
    """(x, y, z, w), by the largest of the four."""
    trace = R[0][0] + R[1][1] + R[2][2]
    i = max(range(4), key=lambda n: trace if n == 3 else R[n][n])
    if i == 3:
        q = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1], 1 + trace]
    else:
        j, k = (i + 1) % 3, (i + 2) % 3
        q = [0, 0, 0, R[k][j] - R[j][k]]
        q[i], q[j], q[k] = 1 + R[i][i] - R[j][j] - R[k][k], R[j][i] + R[i][j], R[k][i] + R[i][k]
    norm = sum(x * x for x in q) ** 0.5
    return [x / norm for x in q]


def number(x):
    return f"{x + 0.0:.12f}"


def places(name, pose):
    rows = [", ".join(map(number, [*R, p])) for R, p in zip(*pose)]
    return {name: ", ".join([*rows, "0.0, 0.0, 0.0, 1.0"]), **{f"{name}_{i}": row for i, row in enumerate(rows)}}


def camera_values(cameras, k):
    c, one = cameras[k], ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0])
    poses = [place(camera["data"]) for camera in cameras]
    fisheye, d = c["distortion_model"] == "equidistant", c["distortion_coefficients"]
    names = dict(zip(["fx", "fy", "cx", "cy"], c["intrinsics"]))
    v = {**names, **{f"d{i}": x for i, x in enumerate(d)}, **dict(zip(["px", "py", "pz", "qx", "qy", "qz", "qw"], [*poses[k][1], *quaternion(poses[k][0])]))}
    kind = "kb4" if fisheye else "pinhole-radtan8" if any(d) else "pinhole"
    lens = {"kb4": ["k1", "k2", "k3", "k4"], "pinhole-radtan8": ["k1", "k2", "p1", "p2"], "pinhole": []}[kind]
    rest = dict.fromkeys(["k3", "k4", "k5", "k6", "rpmax"], 0.0) if kind == "pinhole-radtan8" else {}
    return {
        **{name: number(x) for name, x in v.items()},
        **{"k": k, "n": k + 1, "comma": "," if k else "", "width": c["resolution"][0], "height": c["resolution"][1]},
        **{"kalibr_lens": "equidistant" if fisheye else "radtan", "orb_lens": "KannalaBrandt8" if fisheye else "PinHole"},
        **{"orb_d2": "k3" if fisheye else "p1", "orb_d3": "k4" if fisheye else "p2"},
        "overlaps": ", ".join(str(i) for i in range(len(cameras)) if i != k),
        "basalt_lens": json.dumps({"camera_type": kind, "intrinsics": {**names, **dict(zip(lens, d)), **rest}}),
        **places("T_imu_cam", poses[k]), **places("T_cam_imu", from_to(poses[k], one)),
        **places("T_cam0_cam", from_to(poses[0], poses[k])), **places("T_cam_before", from_to(poses[k], poses[max(k - 1, 0)])),
    }


def filled(text, values, cameras=()):
    def block(match):
        return "".join(filled(match[3], camera) for camera in cameras[int(match[1]) : int(match[2])])

    return re.sub(r"@(\w+)@", lambda match: str(values[match[1]]), re.sub(r"@for (\d) (\d)@(.*?)@end@", block, text, flags=re.S))


def main(sequence, out=None):
    mav, out = pathlib.Path(sequence) / "mav0", pathlib.Path(out or pathlib.Path(sequence) / "configs")
    sensors = [sensor(folder) for folder in sorted(mav.glob("cam[0-9]"))]
    cameras, has_imu = [camera_values(sensors, k) for k in range(len(sensors))], (mav / "imu0").exists()
    imu = sensor(mav / "imu0") if has_imu else {"rate_hz": 200.0}
    manifest = pathlib.Path(sequence) / "manifest.json"  # ours has another gravity, perhaps; a campaign's in sensor.yaml
    gravity = json.loads(manifest.read_text())["scenario"]["imu"]["gravity"] if manifest.exists() else [imu.get("gravity", 9.81)]
    densities = {"gyr_noise": ("gyroscope_noise_density", 1.6968e-4), "gyr_walk": ("gyroscope_random_walk", 1.9393e-5),
                 "acc_noise": ("accelerometer_noise_density", 2e-3), "acc_walk": ("accelerometer_random_walk", 3e-3)}
    rate = sensors[0]["rate_hz"]
    values = {**cameras[0], **{name: number(imu.get(key) or usual) for name, (key, usual) in densities.items()},
              "imu_rate": number(imu["rate_hz"]), "gravity": number(sum(g * g for g in gravity) ** 0.5), "track_rate": number(rate + 1),
              "imu": int(has_imu), "whole_rate": round(rate), "cameras": len(cameras), "pair": min(len(cameras), 2), "stereo": "true" if len(cameras) > 1 else "false"}

    def write(path, template, with_values=values, before=""):
        (out / path).parent.mkdir(parents=True, exist_ok=True)
        text = (pathlib.Path(__file__).parent / "vio" / f"{template}.in").read_text()
        (out / path).write_text(before + filled(text, with_values, cameras))

    if has_imu:
        write("kalibr/camchain-imucam.yaml", "kalibr_imucam_chain.yaml")
        write("openvins/kalibr_imucam_chain.yaml", "kalibr_imucam_chain.yaml", before="%YAML:1.0\n\n")
        write("openvins/kalibr_imu_chain.yaml", "kalibr_imu_chain.yaml")
        write("openvins/estimator_config.yaml", "estimator_config.yaml")
    write("vins_fusion/config.yaml", "vins_config.yaml")
    for k, camera in enumerate(cameras[:2]):
        write(f"vins_fusion/cam{k}.yaml", "vins_pinhole.yaml" if camera["orb_lens"] == "PinHole" else "vins_fisheye.yaml", camera)
    write("orb_slam3/settings.yaml", "orb_slam3.yaml")
    stamps = [line.split(",")[0] for line in (mav / "cam0/data.csv").read_text().splitlines() if line[:1].isdigit()]
    (out / "orb_slam3/times.txt").write_text("\n".join(stamps) + "\n")
    write("basalt/calibration.json", "basalt_calibration.json")


if __name__ == "__main__":
    main(*sys.argv[1:])
