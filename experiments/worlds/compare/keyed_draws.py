"""credence's draws (include/credence/detail/draws.hpp) in numpy: Philox4x32-10 of seed, trial, pose, source, index."""

import numpy as np


def words(seed, trial, source, pose, index=0):
    """Four 32-bit words of each key, as 64-bit numbers; trial, pose and index may be arrays."""
    low = np.uint64(0xFFFFFFFF)
    trial, pose, index = np.broadcast_arrays(*(np.asarray(number, np.uint64) for number in (trial, pose, index)))
    a, b, c, d = trial & low, trial >> np.uint64(32), pose, np.uint64(source << 16) | index
    first, second = seed & 0xFFFFFFFF, seed >> 32
    for _ in range(10):
        p, q = a * np.uint64(0xD2511F53), c * np.uint64(0xCD9E8D57)
        a, b, c, d = ((q >> np.uint64(32)) ^ b ^ np.uint64(first), q & low,
                      (p >> np.uint64(32)) ^ d ^ np.uint64(second), p & low)
        first, second = first + 0x9E3779B9 & 0xFFFFFFFF, second + 0xBB67AE85 & 0xFFFFFFFF
    return a, b, c, d


def share(high, low):
    return ((high << np.uint64(32) | low) >> np.uint64(12)).astype(float) / 2.0**52


def normal(*key):
    """Two standard normal draws of each key: [..., 2]."""
    a, b, c, d = words(*key)
    radius, angle = np.sqrt(-2 * np.log(1 - share(b, a))), 2 * np.pi * share(d, c)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def uniform(*key):
    a, b, _, _ = words(*key)
    return share(b, a)
