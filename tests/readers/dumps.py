"""What h5dump and ncdump print, taken apart: readers of readers.py."""
import functools
import re
import subprocess

import numpy as np


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class H5dump:
    needs = ("h5dump",)

    def __init__(self, path):
        self.path = path

    @functools.lru_cache(maxsize=None)
    def text(self, path):
        kind = ["-A", "-g"] if path.count("/") == 2 else ["-d"]
        return output_of("h5dump", "-y", "-w", "0", "-m", "%.17g", *kind, path, self.path)

    def values(self, path):
        text = self.text(path)
        shape = [int(size) for size in re.search(r"DATASPACE +SIMPLE \{ \( ([\d, ]+) \)", text)[1].split(",")]
        values = np.array(re.search(r"DATA \{(.*?)\}", text, re.DOTALL)[1].split(","), dtype=float)
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
        return output_of("ncdump", "-p", "9,17", *(["-v", name] if name else ["-h"]), self.path)

    def group(self, path):
        _, scenario, arm, *name = path.split("/")
        text = self.text("".join(name)).split(f"group: {scenario} {{")[1].split(f"group: {arm} {{")[1]
        return text.split(f"}} // group {arm}")[0]

    def values(self, path):
        sizes = dict(re.findall(r"(\w+) = (\d+) ;", self.group(path).split("variables:")[0]))
        data = re.search(rf"\n\s+{path.rsplit('/', 1)[1]} =(.*?);", self.group(path).split("data:")[1], re.DOTALL)[1]
        values = np.array(data.replace("_", "nan").replace("NaN", "nan").split(","), dtype=float)
        return values.reshape([int(sizes[name]) for name in self.dimensions(path)])

    def attribute(self, path, name):
        owner = "" if path.count("/") == 2 else path.rsplit("/", 1)[1]
        return re.search(rf"\s{owner}:{name} = \"?(.*?)(?:LL|b)?\"? ;", self.group(path))[1]

    def dimensions(self, path):
        name = path.rsplit("/", 1)[1]
        return re.search(rf"^\s+\w+ {name}\((.*?)\) ;", self.group(path), re.MULTILINE)[1].split(", ")
