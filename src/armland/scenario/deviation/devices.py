"""Which numbers of the plant may differ from the controller's, by device: published range, bound, meaning, source.

A source in round brackets is a published figure; `assumption` says that none was found, and why this range. Shares are of the
nominal value.
"""

from armland.scenario.deviation.spread import Device, Spread, deviates

Own = Spread | None


class UavDeviation(Device):
    """Body, rotors, attitude sensor and own hover of the UAV."""

    mass: Own = deviates(
        (-0.07, 0.07),
        (-0.5, 0.5),
        "share; hull, battery or load not weighed (AR.Drone 2.0 bench data: hulls differ by 7 %)",
    )
    cm_m: Own = deviates(
        (-0.003, 0.003), (-0.05, 0.05), "centre of mass, each axis; assumption: play of the battery", "3"
    )
    inertia: Own = deviates((-0.05, 0.05), (-0.9, 2.0), "share; repeatability of bifilar pendulums, assumption")
    thrust: Own = deviates(
        (-0.06, 0.06),
        (-0.6, 1.0),
        "share, all rotors; (AR.Drone 2.0 motor bench: 1.77 to 1.98 N at full power about 1.86 N)",
    )
    rotor: Own = deviates((-0.04, 0.04), (-0.6, 1.0), "share, each rotor (the same bench: 0.05 N at half power)", "8")
    curve: Own = deviates(
        (-0.1, 0.1),
        (-0.8, 0.8),
        "relative thrust error per relative distance from hover; assumption: a squared "
        "curve fitted over half its range",
    )
    sag_per_s: Own = deviates(
        (0.0, 0.001), (0.0, 0.1), "1/s, share of thrust that the battery loses; assumption: a third in five minutes"
    )
    lag: Own = deviates((-0.2, 0.2), (-0.95, 5.0), "share of the rotors' time constant; assumption")
    tilt_deg: Own = deviates(
        (-1.0, 1.0), (-20.0, 20.0), "roll and pitch that it gets wrong, each; assumption: a flat trim by hand", "2"
    )
    heading_deg: Own = deviates(
        (-5.0, 5.0), (-180.0, 180.0), "heading that it gets wrong, beyond imperfections; assumption"
    )
    gyro_dps: Own = deviates(
        (-0.3, 0.3),
        (-20.0, 20.0),
        "deg/s, bias of each rate; assumption: a low-cost gyro after its offset was taken",
        "3",
    )
    drift_dps: Own = deviates(
        (-0.1, 0.1), (-5.0, 5.0), "deg/s, drift of the heading without a magnetometer; assumption"
    )
    trim_mps2: Own = deviates(
        (-0.2, 0.2),
        (-3.0, 3.0),
        "by how far the integral of its own hover is from its trim at the start; assumption: 2 % of gravity",
    )
    speed_noise_mps: Own = deviates(
        (0.0, 0.03),
        (0.0, 2.0),
        "standard deviation of the velocity that it hovers by, each axis, "
        "correlated over 0.3 s; assumption: optical flow",
    )
    speed_bias_mps: Own = deviates(
        (-0.02, 0.02), (-1.0, 1.0), "velocity that it gets wrong, each axis: it drifts; assumption", "2"
    )
    drag: Own = deviates(
        (-0.3, 0.3), (-1.0, 5.0), "share of the linear drag (quadrotors of this size: 0.39 to 0.54 1/s)"
    )


class LinkDeviation(Device):
    """The wireless link."""

    up_ms: Own = deviates(
        (0.0, 25.0), (-1000.0, 1000.0), "ms upwards beyond the believed delay (tum_ardrone: pings of 25 to 50 ms)"
    )
    down_ms: Own = deviates((0.0, 15.0), (-1000.0, 1000.0), "ms downwards (the same)")
    jitter_ms: Own = deviates((0.0, 10.0), (0.0, 1000.0), "largest further delay, anew for each message; assumption")
    loss: Own = deviates(
        (0.0, 0.05), (0.0, 0.99), "probability that a message is lost; assumption: wireless LAN in a hall"
    )
    burst: Own = deviates(
        (0.0, 0.5), (0.0, 0.99), "correlation of a message's loss with that of the one before; assumption"
    )
    stamp_ms: Own = deviates(
        (-5.0, 5.0),
        (-500.0, 500.0),
        "ms by which the UAV's stamps are late; assumption: clocks synchronised over the link",
    )


class CameraDeviation(Device):
    """Camera on the tool and marker under the UAV."""

    noise: Own = deviates((0.0, 0.5), (-0.9, 20.0), "real noise over claimed noise, less one; assumption")
    exposure: Own = deviates((-0.5, 1.0), (-0.99, 20.0), "share of the exposure time: light; assumption")
    lose: Own = deviates((0.0, 0.03), (0.0, 0.95), "probability of a drop-out beyond the believed one; assumption")
    outlier: Own = deviates((0.0, 0.005), (0.0, 0.95), "probability of an outlier; assumption")
    outlier_m: Own = deviates((0.005, 0.02), (0.0, 10.0), "m, standard deviation of an outlier, each axis; assumption")
    flip: Own = deviates(
        (0.0, 0.005), (0.0, 0.95), "probability of the second solution of a planar marker's pose; assumption"
    )
    delay_ms: Own = deviates(
        (0.0, 15.0), (-50.0, 400.0), "ms beyond the believed delay (tum_ardrone: video 75 ms behind)"
    )
    stamp_ms: Own = deviates(
        (-4.0, 4.0), (-200.0, 200.0), "ms by which its stamps are late; assumption: half an exposure and a read-out"
    )
    mount_m: Own = deviates(
        (-0.001, 0.001),
        (-0.2, 0.2),
        "m, place of camera and marker together, each axis; assumption: hand-eye calibration",
        "3",
    )
    mount_deg: Own = deviates(
        (-0.2, 0.2), (-30.0, 30.0), "attitude of the camera, each axis; assumption: the same", "3"
    )
    focal: Own = deviates((-0.003, 0.003), (-0.5, 0.5), "share of the focal length; assumption")
    centre_px: Own = deviates((-2.0, 2.0), (-500.0, 500.0), "px, principal point, each axis; assumption", "2")


class WrenchDeviation(Device):
    """Force-torque sensor and what it weighs."""

    gain: Own = deviates(
        (-0.01, 0.01), (-0.9, 2.0), "share, each channel; assumption: 1 % of such sensors' data sheets", "6"
    )
    cross: Own = deviates(
        (-0.01, 0.01),
        (-0.9, 0.9),
        "correlation of channels: cross-talk of two forces or of two torques; assumption: 1 %",
        "12",
    )
    drift_nps: Own = deviates((-0.005, 0.005), (-10.0, 10.0), "N/s, each force; assumption: warming up", "3")
    drift_nmps: Own = deviates((-0.0002, 0.0002), (-1.0, 1.0), "N·m/s, each torque; assumption: the same", "3")
    tool_kg: Own = deviates((-0.01, 0.01), (-0.2, 5.0), "kg beyond the believed tool; assumption: cables and screws")
    tool_com_m: Own = deviates(
        (-0.002, 0.002), (-0.02, 0.1), "m, centre of mass of the tool along its axis; assumption"
    )


class ArmDeviation(Device):
    """Encoders, motors and bodies of the arm."""

    encoder_rad: Own = deviates(
        (-2e-4, 2e-4), (-0.5, 0.5), "offset of each encoder; assumption: mastering by a dial gauge", "n"
    )
    torque: Own = deviates(
        (-0.005, 0.005), (-0.5, 0.5), "offset of each joint's torque, share of its limit (LWR III: below 0.5 %)", "n"
    )
    torque_noise: Own = deviates(
        (0.0, 0.0003), (0.0, 0.2), "standard deviation of each torque, share of its limit (LWR III: noise floor 0.03 %)"
    )
    torque_gain: Own = deviates((-0.01, 0.01), (-0.9, 1.0), "share, each joint's torque; assumption", "n")
    delay_ms: Own = deviates(
        (0.0, 1.0), (0.0, 20.0), "ms from command to torque (LWR III: joint loop at 3 kHz, bus at 1 kHz)"
    )
    coulomb: Own = deviates(
        (0.0, 0.003),
        (0.0, 0.5),
        "dry friction of each joint, share of its torque limit; assumption: what a joint torque loop leaves",
        "n",
    )
    viscous_nms: Own = deviates(
        (0.0, 0.8), (0.0, 100.0), "N·m·s/rad of each joint (identified LWR models: 0.19 to 0.84)", "n"
    )
    load_friction: Own = deviates((0.0, 0.01), (0.0, 0.5), "dry friction per torque; assumption")
    compliance: Own = deviates(
        (0.0, 5e-5),
        (0.0, 0.01),
        "rad/(N·m) between each encoder and its link; assumption: harmonic drives of 20 kN·m/rad and more, "
        "those of joints beyond 176 N·m stiffer in proportion",
        "n",
    )
    inertia: Own = deviates(
        (-0.1, 0.1), (-0.9, 5.0), "share of masses, inertias and armature (identified LWR models: 12.4 to 18.5 kg)"
    )


class MagnetDeviation(Device):
    """The electromagnet and the plate's face."""

    force: Own = deviates((-0.1, 0.1), (-0.95, 1.0), "share of the rating; assumption: supply and temperature")
    residual_n: Own = deviates(
        (0.0, 0.5), (0.0, 100.0), "N that it pulls with the current off, beyond the believed (brochure: 0.3 N)"
    )
    gap_m: Own = deviates(
        (0.0, 2e-5), (0.0, 0.005), "m of dirt or paint between the faces; assumption: a layer of paint"
    )
    report: Own = deviates((-0.03, 0.03), (-0.9, 1.0), "share of the force that it reports; assumption")


class HingeDeviation(Device):
    """The spherical hinge and its plate."""

    friction_nm: Own = deviates(
        (0.0, 3e-4), (0.0, 0.1), "N·m of dry friction beyond the believed; assumption: two ball bearings"
    )
    damping_nms: Own = deviates((0.0, 5e-5), (0.0, 0.1), "N·m·s/rad beyond the believed; assumption")
    stiffness_nm: Own = deviates((0.0, 1e-3), (0.0, 1.0), "N·m/rad of a cable across the hinge; assumption")
    askew_deg: Own = deviates(
        (-2.0, 2.0), (-30.0, 30.0), "angle, each axis, at which that cable leaves the plate; assumption", "2"
    )
    play_m: Own = deviates(
        (0.0, 5e-5),
        (0.0, 0.005),
        "m, play along the hinge's upright axis; assumption: two small ball bearings (ISO 5753: 2 to 13 µm each) and their seats",
    )


class CradleDeviation(Device):
    """The cradle."""

    place_m: Own = deviates((-0.003, 0.003), (-0.3, 0.3), "m, each axis; assumption: set up by a tape measure", "3")
    heading_deg: Own = deviates((-1.0, 1.0), (-90.0, 90.0), "deg; assumption: the same")
    friction: Own = deviates((-0.4, 0.4), (-0.95, 2.0), "share of the rails' friction; assumption: dry to wet rubber")


class AirDeviation(Device):
    """What the air does that no model of the controller knows."""

    wind_mps: Own = deviates(
        (0.0, 1.0), (0.0, 30.0), "m/s, mean wind from a direction that is drawn; assumption: a hall with open gates"
    )
    gust_mps: Own = deviates(
        (0.0, 0.25),
        (0.0, 10.0),
        "m/s RMS of each horizontal component, vertical half of it, correlated over 1 s; assumption",
    )
    ground_effect: Own = deviates(
        (0.0, 1.0),
        (0.0, 5.0),
        "share of Cheeseman and Bennett's gain of thrust over floor and cradle, at "
        "half the rotor's area above rails; assumption",
    )
    downwash: Own = deviates(
        (0.0, 0.03),
        (0.0, 1.0),
        "share of the thrust that presses on the tool below the UAV; assumption: the "
        "tool lies between the rotors' wakes",
    )
