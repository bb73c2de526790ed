"""Reads a results file and a trajectory file with everything that Python and the command line have, and compares what
each finds with EXPECTED.tsv (see expected.py).

    readers.py READER STUDY.h5 TRACE.h5 EXPECTED.tsv

READER: one of READERS below. Values agree to 1e-12: sums in another order.
"""
import functools
import importlib.util
import math
import pathlib
import shutil
import sys

import numpy as np

from dumps import H5dump, Ncdump


class H5py:
    needs = ("h5py",)

    def __init__(self, path):
        import h5py
        self.file = h5py.File(path, "r")

    def values(self, path):
        values = self.file[path][:].astype(float)
        if "_FillValue" in self.file[path].attrs:
            values[values == self.file[path].attrs["_FillValue"][0]] = np.nan
        return values

    def attribute(self, path, name):
        value = self.file[path].attrs[name]
        return value.decode() if isinstance(value, bytes) else value

    def dimensions(self, path):
        return [scales[0].name.rsplit("/", 1)[1] for scales in map(lambda d: list(d.values()), self.file[path].dims)]


class NetCDF4:
    needs = ("netCDF4",)

    def __init__(self, path):
        import netCDF4
        self.file = netCDF4.Dataset(path)

    def values(self, path):
        return np.ma.filled(self.file[path][:].astype(float), np.nan)

    def attribute(self, path, name):
        return self.file[path].getncattr(name)

    def dimensions(self, path):
        return self.file[path].dimensions


class XarrayNetCDF4:
    needs = ("xarray", "netCDF4")
    engine = "netcdf4"

    def __init__(self, path):
        self.path = path

    @functools.lru_cache(maxsize=None)
    def group(self, path):
        import xarray
        return xarray.open_dataset(self.path, group=path, engine=self.engine)

    def variable(self, path):
        group, name = path.rsplit("/", 1)
        return self.group(group)[name]

    def values(self, path):
        return self.variable(path).values.astype(float)

    def attribute(self, path, name):
        return (self.group(path) if path.count("/") == 2 else self.variable(path)).attrs[name]

    def dimensions(self, path):
        return self.variable(path).dims


class XarrayH5netcdf(XarrayNetCDF4):
    needs = ("xarray", "h5netcdf")
    engine = "h5netcdf"


READERS = {"h5py": H5py, "netcdf4": NetCDF4, "xarray-netcdf4": XarrayNetCDF4, "xarray-h5netcdf": XarrayH5netcdf,
           "h5dump": H5dump, "ncdump": Ncdump}


def quantity(file, path, name):
    """What the reader finds for a line of EXPECTED.tsv."""
    if name.startswith("attribute:"):
        return file.attribute(path, name.split(":")[1])
    if name == "dimensions":
        return " ".join(file.dimensions(path))
    values, group = file.values(path), path.rsplit("/", 1)[0]
    if name in ("mean", "median"):
        return getattr(np, f"nan{name}")(values)
    if name.startswith(("ratio_at_", "share_at_")):
        counted, step = np.sum(file.values(group + "/status") < 2), int(name.rsplit("_", 1)[1])
        if name.startswith("share"):
            return values[step - 1, 2] / counted
        return values[step - 1, 0] / counted / file.values(group + "/component").size
    if name == "per_row":
        return np.nansum(values) / np.nansum(file.values(group + "/rows"))
    if name == "squared_error":
        robot = 2 + values.shape[1] % 2
        return np.sum((values - file.values(group + "/truth"))[:, :robot] ** 2)
    return {"missing": np.isnan(values).sum(), "zeros": np.sum(values == 0), "failed": np.sum(values >= 2),
            "last": values.flat[-1]}[name]


def same(found, expected):
    """Whether two numbers or texts are; what the tools print is text either way."""
    try:
        return math.isclose(float(found), float(expected), rel_tol=1e-12)
    except (TypeError, ValueError):
        return str(found) == expected


def main(reader, study, trace, expected):
    for need in READERS[reader].needs:
        if importlib.util.find_spec(need) is None and shutil.which(need) is None:
            print(f"SKIPPED: {need} is not installed")
            return 0
    files = {"study": READERS[reader](study), "trace": READERS[reader](trace)}
    facts = [line.split("\t") for line in pathlib.Path(expected).read_text().splitlines()]
    wrong = [(path, name, value, found) for file, path, name, value in facts
             if not same(found := quantity(files[file], path, name), value)]
    for path, name, value, found in wrong:
        print(f"{reader}: {path} {name} is {found}, not {value}")
    print(f"{reader}: {len(facts) - len(wrong)} of {len(facts)} as in the JSON")
    return 1 if wrong or not facts else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
