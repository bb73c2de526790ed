"""Reads a results file and a trajectory file with everything that Python and the command line have, and compares what
each finds with EXPECTED.tsv (see expected.py).

    readers.py READER STUDY.h5 TRACE.h5 EXPECTED.tsv

READER: h5py, netcdf4, xarray-netcdf4, xarray-h5netcdf, h5dump or ncdump. Values agree to 1e-12: sums in another order.
"""
import functools
import importlib.util
import math
import re
import shutil
import subprocess
import sys

import numpy as np


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
        of_group = path.count("/") == 2
        return (self.group(path) if of_group else self.variable(path)).attrs[name]

    def dimensions(self, path):
        return self.variable(path).dims


class XarrayH5netcdf(XarrayNetCDF4):
    needs = ("xarray", "h5netcdf")
    engine = "h5netcdf"


class H5dump:
    needs = ("h5dump",)

    def __init__(self, path):
        self.path = path

    @functools.lru_cache(maxsize=None)
    def text(self, path):
        kind = ["-g"] if path.count("/") == 2 else ["-d"]
        only = ["-A"] if kind == ["-g"] else []
        return subprocess.run(["h5dump", *only, "-y", "-w", "0", "-m", "%.17g", *kind, path, self.path], check=True, capture_output=True, text=True).stdout

    def values(self, path):
        text = self.text(path)
        shape = [int(size) for size in re.search(r"DATASPACE +SIMPLE \{ \( ([\d, ]+) \)", text)[1].split(",")]
        values = np.array(re.search(r"DATA \{(.*?)\}", text, re.DOTALL)[1].replace("-nan", "nan").split(","), dtype=float)
        if '"_FillValue"' in text:
            values[values == float(self.attribute(path, "_FillValue"))] = np.nan
        return values.reshape(shape)

    def attribute(self, path, name):
        found = re.search(rf'ATTRIBUTE "{name}" \{{.*?DATA \{{\s*(?:\(0\): )?(.*?)\s*\}}', self.text(path), re.DOTALL)
        return found[1].strip('"')

    def dimensions(self, path):
        scales = re.search(r'ATTRIBUTE "DIMENSION_LIST" \{.*?DATA \{(.*?)\}', self.text(path), re.DOTALL)[1]
        return re.findall(r'/(\w+)"?\)', scales)


class Ncdump:
    needs = ("ncdump",)

    def __init__(self, path):
        self.path = path

    @functools.lru_cache(maxsize=None)
    def text(self, name):
        """The header, and the values of the variables of that name in all groups."""
        return subprocess.run(["ncdump", "-p", "9,17", *(["-v", name] if name else ["-h"]), self.path], check=True,
                              capture_output=True, text=True).stdout

    def group(self, path):
        _, scenario, arm, *name = path.split("/")
        return self.text("".join(name)).split(f"group: {scenario} {{")[1].split(f"group: {arm} {{")[1].split(f"}} // group {arm}")[0]

    def header(self, path):
        return re.search(rf"^\s+\w+ {path.rsplit('/', 1)[1]}\((.*?)\) ;", self.group(path), re.MULTILINE)

    def values(self, path):
        sizes = dict(re.findall(r"(\w+) = (\d+) ;", self.group(path).split("variables:")[0]))
        data = re.search(rf"\n\s+{path.rsplit('/', 1)[1]} =(.*?);", self.group(path).split("data:")[1], re.DOTALL)[1]
        values = np.array(data.replace("_", "nan").replace("NaN", "nan").split(","), dtype=float)
        return values.reshape([int(sizes[name]) for name in self.dimensions(path)])

    def attribute(self, path, name):
        owner = "" if path.count("/") == 2 else path.rsplit("/", 1)[1]
        return re.search(rf"\s{owner}:{name} = \"?(.*?)(?:LL|b)?\"? ;", self.group(path))[1]

    def dimensions(self, path):
        return self.header(path)[1].split(", ")


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
        share = name.startswith("share")
        return values[step - 1, 2] / counted if share else values[step - 1, 0] / counted / file.values(group + "/component").size
    if name == "per_row":
        return np.nansum(values) / np.nansum(file.values(group + "/rows"))
    if name == "squared_error":
        robot = 2 + values.shape[1] % 2
        return np.sum((values - file.values(group + "/truth"))[:, :robot] ** 2)
    return {"missing": np.isnan(values).sum(), "zeros": np.sum(values == 0), "failed": np.sum(values >= 2),
            "last": values.flat[-1]}[name]


def same(found, expected):
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
    with open(expected) as lines:
        facts = [line.rstrip("\n").split("\t") for line in lines]
    wrong = [(path, name, value, found) for file, path, name, value in facts
             if not same(found := quantity(files[file], path, name), value)]
    for path, name, value, found in wrong:
        print(f"{reader}: {path} {name} is {found}, not {value}")
    print(f"{reader}: {len(facts) - len(wrong)} of {len(facts)} as in the JSON")
    return 1 if wrong or not facts else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
