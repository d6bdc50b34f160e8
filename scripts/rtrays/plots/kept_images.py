# SPDX-License-Identifier: MIT
"""Images of single renders that a run of curves keeps: those of the first seed at the sample counts
`early_images` of the profile."""

from rtrays.documents.curves import clock_of, seconds
from rtrays.documents.document import RunError, value
from rtrays.metrics.flip import require_finite


def require_images(run):
    """Raises RunError unless the images of the run are here, as arrays."""
    if not run.has_images():
        raise RunError(
            f"{run.folder}: has no images, from which this figure is made; rtrays-experiment run"
            " makes them, and git does not keep them"
        )


def finite_image(run, file):
    """Returns linear R, G, B of an image of the run. Raises RunError naming the file if a value is
    not finite."""
    picture = run.image(file)
    require_finite(picture, run.folder / file)
    return picture


def kept_renders(run, curve):
    """Returns the renders of a curve whose images the run keeps, by their samples. Each is a
    repetition of a point with "spp", "seconds" by the clock of the run, and "image", the file.
    Raises RunError without any."""
    files = {value(each, "spp"): value(each, "image") for each in value(curve, "early_images")}
    renders = []
    for point in value(curve, "points"):
        if (spp := value(point, "spp")) in files:
            first = value(point, "repetitions.0")
            time = seconds(curve, first, clock_of(run))
            renders.append({**first, "spp": spp, "seconds": time, "image": files[spp]})
    if not renders:
        raise RunError(
            f"curve {value(curve, 'id')} has no images of single renders; add \"early_images\" to"
            " the profile and run it again"
        )
    return renders
