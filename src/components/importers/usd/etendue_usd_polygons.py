"""Polygons as triangles: fans, and ears where corners turn the other way."""
import numpy

MOST_CORNERS = 4096  # cutting ears takes cubic time: larger polygons become fans


def triangulated(places, counts):
    """The face of each triangle, and its corners' places in the list of corners. `places` are those of all corners of faces."""
    starts = numpy.cumsum(counts) - counts
    per = numpy.maximum(counts - 2, 0)
    faces = numpy.repeat(numpy.arange(len(counts)), per)
    first_triangle = numpy.cumsum(per) - per
    within = numpy.arange(per.sum()) - numpy.repeat(first_triangle, per)
    first = starts[faces]
    triangles = numpy.stack((first, first + within + 1, first + within + 2), axis=1)
    for face, normal in concave(places, counts, starts):
        begin, count = starts[face], counts[face]
        cut = ears(places[begin:begin + count], normal)
        triangles[first_triangle[face]:first_triangle[face] + per[face]] = numpy.array(cut) + begin
    return faces, triangles


def concave(places, counts, starts):
    """[(face, its normal by Newell's method)] of those with a corner that turns the other way."""
    chosen = numpy.nonzero((counts > 3) & (counts <= MOST_CORNERS))[0]
    if not len(chosen):
        return []
    some = counts[chosen]
    ends = numpy.cumsum(some)
    begins = ends - some
    own = numpy.arange(ends[-1]) - numpy.repeat(begins, some)  # the number of each corner within its face
    first, number = numpy.repeat(starts[chosen], some), numpy.repeat(some, some)
    here, after, before = places[first + own], places[first + (own + 1) % number], places[first + (own - 1) % number]
    corner = places[first]  # sums are of places near the face, not near the origin
    normals = numpy.add.reduceat(numpy.cross(here - corner, after - corner), begins, axis=0)
    turns = (numpy.cross(here - before, after - here) * numpy.repeat(normals, some, axis=0)).sum(axis=1)
    least = 1e-6 * (normals ** 2).sum(axis=1)
    bent = numpy.minimum.reduceat(turns, begins) < -least
    return [(chosen[i], normals[i]) for i in numpy.nonzero(bent)[0]]


def ears(points, normal):
    """Corners of triangles of one polygon (Meisters 1975): again and again one that no other corner lies in."""
    axis = int(numpy.abs(normal).argmax())
    x, y = points[:, (axis + 1) % 3], points[:, (axis + 2) % 3]
    if normal[axis] < 0:
        x, y = y, x
    left, cut = list(range(len(points))), []

    def area(a, b, c):
        return (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])

    def is_ear(i):
        a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
        if area(a, b, c) <= 0:
            return False
        return not any(area(a, b, p) >= 0 and area(b, c, p) >= 0 and area(c, a, p) >= 0 for p in left if p not in (a, b, c))

    while len(left) > 3:
        # What crosses itself may have none: any corner then.
        i = next((k for k in range(len(left)) if is_ear(k)), 0)
        cut.append((left[i - 1], left[i], left[(i + 1) % len(left)]))
        del left[i]
    return cut + [tuple(left)]
