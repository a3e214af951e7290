"""Seated people of smooth primitives; rigid. Each sits on a chair whose seat is at 0.46 m, looks to +z, and has its hands on a desk."""
import numpy as np


def head(o, place, turn, nod, skin="skin", hair="hair"):
    with o.at(place, turn, nod):
        o.cushion("head", skin, (0, 0.02, 0.005), (0.074, 0.112, 0.093), 0.4, 0.95, (12, 18))
        o.cushion("head", skin, (0, -0.055, 0.03), (0.052, 0.055, 0.055), 0.4, 0.95, (8, 14))  # chin
        o.tube("head", skin, [(0, 0.03, 0.09), (0, 0.0, 0.101), (0, -0.012, 0.094)], (0.008, 0.012, 0.011), 0.4, 8, 3)  # nose
        for side in (-1, 1):
            o.cushion("head", skin, (0.075 * side, 0.005, -0.005), (0.01, 0.032, 0.02), 0.4, 0.9, (6, 10))  # ear
            o.cushion("eyes", "pages", (0.03 * side, 0.03, 0.083), (0.014, 0.008, 0.008), 0.4, 1.0, (6, 10))
            o.cushion("brows", hair, (0.03 * side, 0.03, 0.0885), (0.006, 0.006, 0.004), 0.4, 1.0, (6, 8))
            o.tube("brows", hair, [(0.014 * side, 0.05, 0.091), (0.03 * side, 0.055, 0.09), (0.045 * side, 0.049, 0.082)], (0.003, 0.004, 0.003), 0.4, 6, 2)
        o.tube("mouth", "red", [(-0.022, -0.047, 0.082), (0, -0.05, 0.089), (0.022, -0.047, 0.082)], (0.003, 0.005, 0.003), 0.4, 6, 2)
        o.cushion("hair", hair, (0, 0.06, -0.022), (0.083, 0.088, 0.092), 0.4, 0.95, (9, 18))
        o.cushion("hair", hair, (0, 0.015, -0.045), (0.079, 0.1, 0.066), 0.4, 0.95, (8, 16))


def hand(o, wrist, direction, skin="skin"):
    wrist, along = np.array(wrist, float), np.array(direction, float) / np.linalg.norm(direction)
    side = np.cross(along, (0, 1, 0))
    palm = wrist + 0.07 * along
    o.tube("hand", skin, [wrist, palm], (0.026, 0.036), 0.4, 12, 3, 0.5)
    for k in range(4):
        foot = palm + side * 0.02 * (k - 1.5)
        o.tube("hand", skin, [foot, foot + 0.045 * along + (0, 0.006, 0) + side * 0.004 * (k - 1.5), foot + 0.085 * along - (0, 0.008, 0) + side * 0.006 * (k - 1.5)],
               (0.0095, 0.009, 0.007), 0.4, 8, 2)


def seated(o, cloth, trousers, desk=0.74, lean=0.12, look=0.0, nod=0.1, reach=(0.38, 0.3), lift=(0.0, 0.0), skin="skin", hair="hair"):
    """reach, lift: how far before the body, and how far above the desk, the left and right hands are."""
    shoulder = np.array((0, 1.04, -0.02 + lean))
    o.tube("torso", cloth, [(0, 0.52, -0.02), (0, 0.66, 0.0), (0, 0.84, 0.02 + 0.5 * lean), (0, 0.98, lean), (0, 1.06, lean - 0.02)],
           (0.165, 0.155, 0.17, 0.175, 0.11), 0.5, 24, 4, 0.66)
    o.tube("neck", skin, [(0, 1.05, lean - 0.02), (0, 1.17, lean + 0.0)], (0.058, 0.052), 0.4, 20, 10)
    o.tube("collar", cloth, [(0, 1.075, lean - 0.022), (0, 1.10, lean - 0.016)], (0.08, 0.07), 0.5, 18, 2)
    head(o, (0, 1.27, lean + 0.02), look, nod, skin, hair)
    for side, far, up in ((-1, reach[0], lift[0]), (1, reach[1], lift[1])):
        top = shoulder + (0.185 * side, -0.02, -0.01)
        wrist = np.array((0.16 * side, desk + 0.035 + up, lean + far))
        elbow = (top + wrist) / 2 + np.array((0.09 * side, -0.11 + 0.3 * up, -0.05))
        o.tube("arm", cloth, [top - (0.05 * side, -0.01, 0), top, (top + elbow) / 2, elbow, (elbow + wrist) / 2, wrist], (0.058, 0.06, 0.051, 0.046, 0.042, 0.034), 0.5, 12, 3)
        hand(o, wrist, wrist + (0, -0.02 - 0.4 * up, 0.02) - elbow, skin)
        hip, knee, ankle = np.array((0.1 * side, 0.52, 0.0)), np.array((0.14 * side, 0.52, 0.44)), np.array((0.14 * side, 0.08, 0.42 + 0.08 * side))
        o.tube("leg", trousers, [hip, (hip + knee) / 2, knee, (knee + ankle) / 2, ankle], (0.095, 0.085, 0.066, 0.058, 0.05), 0.5, 14, 3)
        o.cushion("shoe", "dark", ankle + (0, -0.035, 0.07), (0.048, 0.045, 0.14), 0.4, 0.6, (8, 16))
