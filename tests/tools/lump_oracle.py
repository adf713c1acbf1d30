"""The stiffness that a rigid flat punch feels on bonded elastic layers; for lump_test.cpp.

usage: lump_oracle.py RADIUS NU STIFFNESS,THICKNESS ... STIFFNESS        the topmost layer first
Stiffnesses are those of a half-space of the layer alone under the punch. Prints the stiffness of the stack.

Independent of palpate's: compressible elasticity of any Poisson's ratio, the transformed equations integrated
through each layer by matrix exponentials, and the pressure under the punch not assumed but solved for, so that
the surface below it stays flat (an Abel transform turns the dual integral equations into one of Fredholm's).
Sources: I. N. Sneddon, Fourier Transforms, 1951, chapters 10 and 14; Lebedev and Ufliand, PMM 22 (1958).
"""

import sys

import numpy
from scipy.linalg import expm


def equations(k, mu, nu):
    """d/dz of (radial, vertical displacement, shear, normal stress) of wave number k."""
    lam = 2 * mu * nu / (1 - 2 * nu)
    c = lam + 2 * mu
    return numpy.array(
        [
            [0, k, 1 / mu, 0],
            [-lam * k / c, 0, 0, 1 / c],
            [k * k * (c - lam * lam / c), 0, 0, lam * k / c],
            [0, 0, -k, 0],
        ]
    )


def flexibility(k, layers, nu):
    """Vertical displacement of the surface by the pressure on it."""
    ground = equations(k, layers[-1][0], nu) + k * numpy.eye(4)
    states = numpy.linalg.svd(ground @ ground)[2][2:].T  # what dies out downwards
    for mu, thickness in reversed(layers[:-1]):
        pieces = max(1, int(numpy.ceil(2 * k * thickness)))
        upwards = expm(-equations(k, mu, nu) * thickness / pieces)
        for _ in range(pieces):
            states = upwards @ states
            states = states @ numpy.linalg.inv(states[:2])
    return numpy.linalg.solve(states[2:] @ numpy.linalg.inv(states[:2]), [0, -1])[1]


def punch(layers, radius, nu, points=32, waves=400):
    t, w = numpy.polynomial.legendre.leggauss(points)
    t, w = radius * (t + 1) / 2, radius * w / 2
    k, kw = numpy.polynomial.legendre.leggauss(waves)
    last = 12 / layers[0][1]
    k, kw = last * (k + 1) / 2, last * kw / 2
    alone = (1 - nu) / layers[0][0]
    excess = numpy.array([flexibility(x, layers, nu) * x / alone - 1 for x in k])
    waves_at = numpy.cos(numpy.outer(t, k))
    kernel = 2 / numpy.pi * (waves_at * (excess * kw)) @ waves_at.T
    density = numpy.linalg.solve(numpy.eye(points) + kernel * w, numpy.full(points, 2 / numpy.pi / alone))
    return 2 * numpy.pi * numpy.sum(w * density)


radius, nu = float(sys.argv[1]), float(sys.argv[2])
layers = [tuple(float(x) for x in layer.split(",")) for layer in sys.argv[3:]]
# K = 2 a E / (1 - nu^2) = 4 a mu / (1 - nu)
layers = [(layer[0] * (1 - nu) / (4 * radius), layer[1] if len(layer) > 1 else 1.0) for layer in layers]
print(punch(layers, radius, nu))
