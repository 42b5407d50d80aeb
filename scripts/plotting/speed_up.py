"""Times as fast as a technique, at its best, in the same run."""
import json
import math

from plotting.results import median, param


def evaluated_pixels(point):
    return (point.get("metrics") or {}).get("evaluated_pixels")


def ns_per_view_sample(point, time):
    ms, pixels = median(point, time), evaluated_pixels(point)
    return ms * 1e6 / pixels if ms is not None and pixels else None


def speed_ups(points, anchor, time):
    """A function of a point: the shortest median of the anchor's points that agree with it in scene, frame and all
    parameters that both have, over its own. None where there is no such point."""
    anchors = [p for p in points if p["technique"] == anchor and p["status"] == "ok" and median(p, time)]
    shared = {}

    def agrees(point, other):
        keys = shared.setdefault(
            point["technique"], [k for k in point["params"] if any(k in a["params"] for a in anchors)]
        )
        return (
            point["scene"] == other["scene"]
            and point.get("frame") == other.get("frame")
            and all(json.dumps(param(point, k)) == json.dumps(param(other, k)) for k in keys)
        )

    def ratio(point):
        own = median(point, time)
        best = min((median(a, time) for a in anchors if agrees(point, a)), default=math.nan)
        return best / own if own and not math.isnan(best) else None

    return ratio
