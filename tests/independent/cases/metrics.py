"""Metrics of a moment against NumPy, SciPy and scikit-learn."""

import numpy
from scipy import spatial
from sklearn import cluster

from case import Case


def cases():
    draw = numpy.random.default_rng(61)
    for dimensions in (2, 3):
        positions = draw.uniform(0, 30, (80, dimensions))
        velocities = draw.normal(0.5, 1, (80, dimensions))
        moment = {"positions": positions, "velocities": velocities}

        def of(metric, expected, **more):
            return Case(f"{metric}, {dimensions}-D{more or ''}", "metric", moment | {"id": metric} | more, expected)

        speeds = numpy.linalg.norm(velocities, axis=1)
        headings = velocities / speeds[:, None]
        yield of("polarisation", numpy.linalg.norm(headings.mean(axis=0)))
        yield of("mean_speed", speeds.mean())
        centre = numpy.linalg.norm(positions - positions.mean(axis=0), axis=1)
        yield of("mean_distance_to_centre", centre.mean())
        yield of("median_distance_to_centre", numpy.median(centre))
        nearest = spatial.cKDTree(positions).query(positions, 2)[0][:, 1]
        yield of("nearest_neighbour_distance", nearest.mean())
        period = [30.0] * dimensions
        nearest = spatial.cKDTree(positions, boxsize=period).query(positions, 2)[0][:, 1]
        yield of("nearest_neighbour_distance", nearest.mean(), period=period)
        for distance in (1.5, 3.0, 5.0):
            single = cluster.AgglomerativeClustering(None, linkage="single", distance_threshold=distance).fit(positions)
            groups = float(single.n_clusters_)
            yield of("group_count", groups, parameters={"linking_distance": distance})
