"""The landing: the UAV comes to its station, the arm catches it, carries it to the cradle, puts it down and lets go."""

from armland.mission.missions.keys import GEAR, HELD, SHARED
from armland.mission.supervisor.ends import FINALS
from armland.mission.table.mission import At, Criterion, Mission
from armland.mission.table.phases import Condition, Guard, Phase

C, G = Condition, Guard

PHASES = (
    Phase(
        "self_test",
        kind="ground",
        arm="hold",
        uav="autonomous",
        magnet="test",
        free=True,
        on_timeout="refused",
        guards=(
            G("guide", (C("magnet_ready", ">", "half"), C("bias_known", ">", "half"), C("uav_seen", ">", "half")), 0.2),
        ),
    ),
    Phase(
        "guide",
        arm="hold",
        uav="station",
        free=True,
        timeout_s=12.0,
        guards=(G("approach", (C("uav_error", "<", "uav_error_m"), C("uav_speed", "<", "uav_speed_mps")), 0.2),),
    ),
    Phase(
        "approach",
        arm="join",
        uav="station",
        free=True,
        duration_s=1.5,
        timeout_s=4.0,
        on_timeout="miss",
        guards=(G("align", (C("progress", ">", "almost_one"),)),),
    ),
    Phase(
        "align",
        arm="track",
        uav="station",
        timeout_s=8.0,
        on_timeout="miss",
        guards=(
            G(
                "close",
                (
                    C("offset", "<", "align_offset_m"),
                    C("relative_speed", "<", "align_speed_mps"),
                    C("tilt", "<", "align_tilt_deg"),
                    C("uav_seen", ">", "half"),
                ),
                0.1,
            ),
        ),
    ),
    Phase(
        "close",
        load="impact",
        kind="touch",
        arm="close",
        uav="station",
        magnet="on",
        duration_s=1.0,
        timeout_s=1.5,
        on_timeout="miss",
        guards=(
            G("capture", (C("contact", ">", "half"),)),
            G("miss", (C("offset", ">", "lost_offset_m"),), 0.02),
            G("miss", (C("uav_seen", "<", "half"),), 0.2),
        ),
    ),
    Phase(
        "capture",
        load="impact",
        kind="touch",
        arm="hold",
        uav="ramp",
        share="test",
        magnet="on",
        held=True,
        # Until the arm carries, a UAV without link flies by itself.
        link="caught",
        timeout_s=1.5,
        on_timeout="miss",
        guards=(
            G("miss", (C("gap", ">", "let_go_m"),), 0.02),
            G("hand_over", (C("pull", ">", "pull_seen_n"), C("elapsed", ">", "settled_s")), 0.1),
        ),
    ),
    Phase(
        "hand_over",
        kind="held",
        arm="hold",
        uav="ramp",
        share="carry",
        magnet="on",
        held=True,
        link="held",
        observe=True,
        timeout_s=6.0,
        on_timeout="holding",
        guards=(G("carry", (C("thrust_left", "<", "thrust_left_n"), C("arm_share", ">", "share_carried")), 0.1),),
    ),
    Phase(
        "carry",
        kind="held",
        arm="move",
        uav="ramp",
        share="carry",
        magnet="on",
        held=True,
        link="held",
        observe=True,
        duration_s=2.5,
        timeout_s=6.0,
        on_timeout="holding",
        guards=(G("set_down", (C("progress", ">", "almost_one"), C("arm_error", "<", "arm_error_m")), 0.1),),
    ),
    Phase(
        "set_down",
        load="impact",
        kind="held",
        arm="move",
        uav="ramp",
        share="carry",
        magnet="on",
        held=True,
        link="held",
        duration_s=2.0,
        timeout_s=4.0,
        on_timeout="holding",
        guards=(G("unload", (C("ground_share", ">", "share_touched"), C("progress", ">", "half")), 0.02),),
    ),
    Phase(
        "unload",
        load="impact",
        kind="cradle",
        link="landed",
        arm="yield",
        uav="ramp",
        share="none",
        magnet="on",
        timeout_s=8.0,
        on_timeout="secured",
        guards=(
            G(
                "release",
                (
                    C("ground_share", ">", "share_resting"),
                    C("hinge_force", "<", "force_free_n"),
                    C("rotors", "<", "rotors_off_n"),
                ),
                0.2,
            ),
        ),
    ),
    Phase(
        "release",
        kind="cradle",
        arm="yield",
        uav="off",
        timeout_s=3.0,
        on_timeout="secured",
        guards=(G("withdraw", (C("elapsed", ">", "coil_off_s"), C("hinge_force", "<", "force_free_n")), 0.1),),
    ),
    Phase(
        "withdraw",
        kind="cradle",
        arm="back_off",
        uav="off",
        duration_s=1.2,
        timeout_s=4.0,
        on_timeout="secured",
        guards=(
            G(
                "done",
                (C("progress", ">", "almost_one"), C("retreat", ">", "retreat_m"), C("contact", "<", "half")),
                0.1,
            ),
        ),
    ),
    Phase(
        "miss",
        arm="back_off",
        uav="station",
        duration_s=0.8,
        timeout_s=3.0,
        guards=(
            G("abort", (C("retries", ">", "retries_allowed"),)),
            G("guide", (C("progress", ">", "almost_one"), C("uav_seen", ">", "half")), 0.1),
        ),
    ),
    *FINALS,
)

TARGETS = {
    "carry": At("put_down_m", 1.0, "above_m"),
    # A little further than the rails, so that it arrives there with speed.
    "set_down": At("put_down_m", -0.004),
}

LANDING = Mission(
    name="landing",
    summary="catch a flying UAV and put it down on the cradle",
    start="air",
    phases=lambda _: PHASES,
    uses=(*SHARED, *GEAR, *HELD),
    points=lambda _: (
        At("catch_m", -1.0, "wait_below_m"),
        At("catch_m"),
        At("put_down_m", 1.0, "above_m"),
        At("put_down_m"),
        At("put_down_m", -1.0, "withdraw_m"),
    ),
    targets=TARGETS,
    timeouts={
        "self_test": "magnet, bias of the force sensor or sight of the UAV were not ready: check magnet and camera",
        "guide": "the UAV did not come to its station: check that it obeys and has room",
        "miss": "the capture was missed too often: check wind, marker and magnet",
        "hand_over": "the arm did not take the weight over: check that the UAV obeys its thrust command",
        "carry": "the arm did not arrive: look for what is in its way",
        "set_down": "the cradle was not felt: check its place",
        "unload": "the cradle did not take the weight over",
        "release": "the hinge did not come free of force: the plate may stick",
        "withdraw": "the plate may stick to the magnet",
    },
    criteria=(
        Criterion("touchdown_speed", 0.15, "m/s", "speed of the pivot when the rails are touched first"),
        Criterion("touchdown_tilt", 3.0, "deg", "tilt of the UAV then"),
        Criterion("placed", 0.010, "m", "distance to the cradle's middle at the end"),
        Criterion("rest", 0.01, "m/s", "speed at the end"),
    ),
    judged_as="landing",
    praise="landed",
    doc="""The ground guides the UAV to `place.catch_m` by camera and link. The arm waits below, joins it, follows it from
`place.standoff_m` below its plate and closes the gap when offset, speed and tilt allow; the magnet grips. A pull of the rotors
tests the grip, then the thrust ramps down while the arm takes the weight over. The arm carries the UAV above the cradle and sets
it down; the rotors stop when the rails carry, the magnet opens when the hinge is free of force, and the arm draws back.
A capture that is missed is tried again `bounds.retries` times.""",
)
