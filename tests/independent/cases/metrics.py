"""Metrics of a moment against NumPy, SciPy and scikit-learn, in open space and in periodic boxes."""

import numpy
from scipy import sparse, spatial
from sklearn import cluster, decomposition

from case import Case

MEMBERS = 80
SIDE = 30.0
RIM = 0.5


def cases():
    for dimensions in (1, 2, 3):
        draw = numpy.random.default_rng(60 + dimensions)
        for name, positions, velocities in (
            ("spread out", draw.uniform(0, SIDE, (MEMBERS, dimensions)), draw.normal(0.5, 1, (MEMBERS, dimensions))),
            ("in two heaps", two_heaps(draw, dimensions), draw.normal(-0.2, 2, (MEMBERS, dimensions))),
            ("some at rest", draw.uniform(0, SIDE, (MEMBERS, dimensions)), some_at_rest(draw, dimensions)),
            ("few", draw.uniform(0, SIDE, (8, dimensions)), draw.normal(0, 1, (8, dimensions))),
        ):
            for period in (None, SIDE):
                yield from of_moment(f"{dimensions}-D, {name}", positions, velocities, period)


def two_heaps(draw, dimensions):
    """Two heaps that lie across the seam of a periodic box."""
    centres = numpy.where(numpy.arange(MEMBERS)[:, None] < MEMBERS // 3, RIM, SIDE / 2)
    return (centres + draw.normal(0, 1.5, (MEMBERS, dimensions))) % SIDE


def some_at_rest(draw, dimensions):
    velocities = draw.normal(0, 1, (MEMBERS, dimensions))
    velocities[::5] = 0
    return velocities


def of_moment(name, positions, velocities, period):
    members, dimensions = positions.shape
    moment = {"positions": positions, "velocities": velocities}
    if period:
        moment["period"] = [period] * dimensions
        name += ", periodic"

    def of(metric, expected, **parameters):
        given = moment | {"id": metric, "parameters": parameters}
        return Case(f"{metric}, {name}{parameters or ''}", "metric", given, expected, relative=1e-9, absolute=1e-9)

    speeds = numpy.linalg.norm(velocities, axis=1)
    moves = speeds > 1e-12
    headings = velocities[moves] / speeds[moves, None]
    order = headings.mean(axis=0)
    yield of("polarisation", numpy.linalg.norm(order))
    yield of("weighted_polarisation", numpy.linalg.norm(velocities.sum(axis=0)) / speeds.sum())
    turned = headings @ order / numpy.linalg.norm(order)
    yield of("mean_angular_deviation", numpy.degrees(numpy.arccos(numpy.clip(turned, -1, 1))).mean())
    yield of("mean_speed", speeds.mean())
    yield of("speed_sd", speeds.std(ddof=1))
    yield of("group_speed", numpy.linalg.norm(velocities.mean(axis=0)))

    def offsets(centre, places):
        away = places - centre
        return away - period * numpy.round(away / period) if period else away

    def centre(places):
        if not period:
            return places.mean(axis=0)
        angles = 2 * numpy.pi * places / period
        return numpy.arctan2(numpy.sin(angles).mean(axis=0), numpy.cos(angles).mean(axis=0)) / (2 * numpy.pi) * period

    away = offsets(centre(positions), positions)
    from_centre = numpy.linalg.norm(away, axis=1)
    yield of("mean_distance_to_centre", from_centre.mean())
    yield of("median_distance_to_centre", numpy.median(from_centre))
    yield of("expanse", numpy.sqrt((from_centre**2).mean()))
    if dimensions > 1:
        outward = offsets(centre(positions[moves]), positions[moves])
        outward /= numpy.linalg.norm(outward, axis=1)[:, None]
        cross = numpy.cross(*(numpy.pad(vectors, ((0, 0), (0, 3 - dimensions))) for vectors in (outward, headings)))
        yield of("angular_momentum", numpy.linalg.norm(cross.mean(axis=0)))
    if dimensions == 2:
        yield of("signed_angular_momentum", cross[:, 2].mean())

    between = positions[None, :] - positions[:, None]
    if period:
        between -= period * numpy.round(between / period)
    distances = numpy.linalg.norm(between, axis=2)
    pairs = distances[numpy.triu_indices(members, 1)]
    yield of("mean_pair_distance", pairs.mean())
    yield of("max_pair_distance", pairs.max())
    tree = spatial.cKDTree(positions % period if period else positions, boxsize=period)
    nearest = tree.query(tree.data, 7)[0][:, 1:]
    yield of("nearest_neighbour_distance", nearest[:, 0].mean())
    yield of("nearest_neighbour_distance_sd", nearest[:, 0].std(ddof=1))
    yield of("nearest_neighbour_distance_max", nearest[:, 0].max())
    for count in (1, 3, 6):
        yield of("kth_neighbour_distance", nearest[:, count - 1].mean(), neighbours=count)
        yield of("k_nearest_distance", nearest[:, :count].mean(), neighbours=count)
    if dimensions == 2:
        sixth = numpy.argsort(distances, axis=1, kind="stable")[:, 1:7]
        bonds = numpy.take_along_axis(between, sixth[:, :, None], axis=1)
        each = numpy.exp(6j * numpy.arctan2(bonds[..., 1], bonds[..., 0])).mean(axis=1)
        yield of("hexatic_order", abs(each.mean()))
        yield of("local_hexatic_order", abs(each).mean())
    for far in (0.5, 2.0):
        yield of("stragglers", (nearest[:, 0] > far).mean(), distance=far)
        yield of("overlapping_pairs", float((pairs < 2 * far).sum()), body_radius=far)
    for reach, wanted in ((2.0, 1.5), (4.0, 3.0)):
        edges = pairs[pairs < reach]
        energy = 2 * ((edges - wanted) ** 2).sum() / (2 * len(edges) + 1)
        yield of("deviation_energy", energy, interaction_radius=reach, spacing=wanted)
        if len(edges) > 0:
            yield of("mean_edge_length", edges.mean(), interaction_radius=reach)
    for reach, body in ((3.0, 0.2), (6.0, 0.5)):
        shares = []
        for own in range(members):
            near = [j for j in range(members) if j != own and distances[own, j] <= reach + 2 * body]
            ways = [between[own, j] for j in near]
            def hidden(to):
                at = [numpy.clip(other @ to / (to @ to), 0, 1) for other in ways]
                aside = [numpy.linalg.norm(other - share * to) for other, share in zip(ways, at)]
                return any(a < body and other @ other < to @ to for a, other in zip(aside, ways))
            if near:
                shares.append(numpy.mean([not hidden(to) for to in ways]))
        if shares:
            yield of("visible_share", numpy.mean(shares), view_radius=reach, body_radius=body)

    for distance in (0.2, 1.5, 3.0, 5.0):
        labels = cluster.AgglomerativeClustering(
            None, linkage="single", metric="precomputed", distance_threshold=numpy.nextafter(distance, 2 * distance)
        ).fit_predict(distances)
        sizes = numpy.unique_counts(labels).counts
        shares = sizes / members
        entropy = -(shares * numpy.log(shares)).sum()
        reach = {"linking_distance": distance}
        yield of("group_count", float(len(sizes)), **reach)
        yield of("largest_group_size", float(sizes.max()), **reach)
        yield of("largest_group_share", shares.max(), **reach)
        yield of("group_entropy", entropy, **reach)
        yield of("fragmented", float(len(sizes) > 1), **reach)
        yield of("balance", entropy / numpy.log(len(sizes)) if len(sizes) > 1 else None, **reach)
        for least in (1, 3, 5):
            labels = cluster.DBSCAN(eps=distance, min_samples=least, metric="precomputed").fit_predict(distances)
            sizes = numpy.unique_counts(labels[labels >= 0]).counts
            dense = {"eps": distance, "min_samples": least}
            yield of("dbscan_clusters", float(len(sizes)), **dense)
            yield of("dbscan_noise", float((labels < 0).sum()), **dense)
            yield of("dbscan_largest", float(sizes.max(initial=0)), **dense)
    seen = {"view_radius": 0.8, "body_radius": 0.1}
    for reading, reach in (("literal", 2 * (0.8 + 0.1)), ("mutual", 0.8 + 2 * 0.1)):
        count, labels = sparse.csgraph.connected_components(sparse.csr_array(distances <= reach))
        yield of(f"view_groups_{reading}", float(count), **seen)
        yield of(f"view_largest_share_{reading}", numpy.bincount(labels).max() / members, **seen)

    if not period and dimensions > 1:
        hull = spatial.ConvexHull(positions)
        if dimensions == 2:
            # of a hull in the plane SciPy calls the perimeter its area
            yield of("hull_area", hull.volume)
            yield of("hull_perimeter", hull.area)
            yield of("hull_vertices", float(len(hull.vertices)))
        else:
            yield of("hull_volume", hull.volume)
            yield of("hull_surface", hull.area)
        first, second = decomposition.PCA().fit(positions).explained_variance_[:2]
        yield of("elongation", 1 - numpy.sqrt(second / first))
    if not period and dimensions == 2:
        domains = domains_of_danger(positions)
        yield of("domain_of_danger_median", numpy.median(domains))
        yield of("domain_of_danger_max", domains.max())


def domains_of_danger(positions):
    """Areas of the Voronoi cells within the convex hull: the hull, cut at the bisector with each other member."""
    hull = positions[spatial.ConvexHull(positions).vertices]
    areas = []
    for me, own in enumerate(positions):
        cell = hull
        for other in numpy.delete(positions, me, axis=0):
            normal = other - own
            cell = cut(cell, normal, normal @ (own + other) / 2)
        x, y = cell.T
        areas.append(abs(x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1)) / 2)
    return numpy.array(areas)


def cut(polygon, normal, most):
    """The part of a convex polygon where `normal @ place <= most` (Sutherland and Hodgman)."""
    beyond = polygon @ normal - most
    kept = []
    for k, place in enumerate(polygon):
        after = (k + 1) % len(polygon)
        if beyond[k] <= 0:
            kept.append(place)
        if (beyond[k] < 0) != (beyond[after] < 0) and beyond[k] != beyond[after]:
            share = beyond[k] / (beyond[k] - beyond[after])
            kept.append(place + share * (polygon[after] - place))
    return numpy.array(kept)
