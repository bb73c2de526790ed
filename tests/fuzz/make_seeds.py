"""make_seeds.py RESULTS SEEDS: the seeds in HDF5. Results are copied from the folder RESULTS, without the attributes
that no reader of credence looks at, all but one of them without checksums, which a mutation would seldom get past, and
with the cells compressed; records are made up."""

import pathlib
import sys

import h5py
import numpy as np

CHECKSUMS = ("crc32",)
FOR_OTHERS = ("long_name", "units", "DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME", "_FillValue", "flag_values",
              "flag_meanings", "series", "role", "part_of", "dimension", "rows", "more_rows", "_Netcdf4Dimid")


def copy_attributes(source, target, left_out):
    """As they are in the file: text of a fixed length stays that."""
    for name in source.attrs:
        if name in left_out:
            continue
        attribute = h5py.h5a.open(source.id, name.encode())
        copy = h5py.h5a.create(target.id, name.encode(), attribute.get_type(), attribute.get_space())
        value = np.empty(attribute.shape, dtype=attribute.dtype)
        attribute.read(value)
        copy.write(value)


def copy_group(source, target, left_out):
    copy_attributes(source, target, left_out)
    for name, item in source.items():
        if isinstance(item, h5py.Group):
            group = target.create_group(name, track_order=True)
            if name == "run":  # facts of the machine and the clock: some of anybody's
                group.attrs["compiler"] = np.bytes_("any")
                group.attrs["threads"] = np.bytes_("1")
            else:
                copy_group(item, group, left_out)
            continue
        packed = {"compression": 9, "shuffle": True} if item.size >= 4096 else {}
        copy_attributes(item, target.create_dataset(name, data=item[()], **packed), left_out)


def copy_results(path, target, libver, left_out=FOR_OTHERS + CHECKSUMS):
    with h5py.File(path) as source, h5py.File(target, "w", libver=libver, track_order=True) as copy:
        copy_group(source, copy, left_out)


def write(path, datasets, libver=("earliest", "v108"), groups=None, attributes=(), **options):
    with h5py.File(path, "w", libver=libver) as file:
        for name, values in datasets.items():
            file.create_dataset(name, data=values, track_times=False, **options)
        if groups is not None:
            file.attrs["groups"] = groups
        for name, value in attributes:
            *place, name = name.rsplit("/", 1)
            (file[place[0]] if place else file).attrs[name] = value


def noise(poses, features, edges=0):
    rng = np.random.default_rng(1)
    arrays = {"odometry": rng.normal(size=(poses, 3))}
    for name in ("walk", "deformation", "measurement"):
        arrays[name] = rng.normal(size=(poses, features, 2))
    if edges:
        arrays["edge"] = rng.normal(size=(poses, edges, 2))
    return arrays


def record(trials, steps, n, m=0):
    rng = np.random.default_rng(2)
    arrays = {"error": rng.normal(size=(trials, steps, n)),
              "covariance": np.broadcast_to(np.eye(n) + 0.25, (trials, steps, n, n)).copy()}
    if m:
        arrays["innovation"] = rng.normal(size=(trials, steps, m))
        arrays["innovation_covariance"] = np.broadcast_to(np.eye(m) * 2, (trials, steps, m, m)).copy()
    return arrays


def write_elsewhere(path, name, datasets):
    """The first of the datasets lies in another file: behind a link, by its storage, or as a virtual one."""
    first, *others = datasets
    shape = datasets[first].shape
    for way in ("link", "storage", "virtual"):
        with h5py.File(path / f"elsewhere-{way}.h5", "w", libver="latest") as file:
            for other in others:
                file[other] = datasets[other]
            if way == "link":
                file[first] = h5py.ExternalLink(name, "/x")
            elif way == "storage":
                file.create_dataset(first, shape, "f8", external=[(name, 0, 8 * datasets[first].size)])
            else:
                unlimited = (None, *shape[1:])
                layout = h5py.VirtualLayout(shape, "f8", maxshape=unlimited)
                all_rows = slice(0, h5py.h5s.UNLIMITED, 1)
                layout[all_rows] = h5py.VirtualSource(name, "x", shape, "f8", maxshape=unlimited)[all_rows]
                file.create_virtual_dataset(first, layout)


def write_foreign_types(path, datasets):
    """Real numbers of other kinds."""
    for kind in (">f8", "f2", "longdouble", "i4"):
        write(path / f"type-{np.dtype(kind).name}{'-big' if kind[0] == '>' else ''}.h5",
              {name: values.astype(kind) for name, values in datasets.items()})


def write_noise(folder):
    write_elsewhere(folder, "elsewhere.h5", noise(2, 1))
    write_foreign_types(folder, noise(2, 1))
    write(folder / "plain.h5", noise(2, 1), libver="earliest")
    write(folder / "headers.h5", noise(2, 1))
    write(folder / "edges.h5", noise(3, 2, 1))
    write(folder / "latest.h5", noise(2, 1, 1), libver="latest")
    write(folder / "packed.h5", noise(3, 2, 1), compression=9, chunks=True)
    write(folder / "singles.h5", {name: values.astype("f4") for name, values in noise(2, 1).items()})


def write_judge(folder):
    write_elsewhere(folder, "elsewhere.h5", record(2, 2, 2))
    write_foreign_types(folder, record(2, 2, 2))
    write(folder / "plain.h5", record(3, 2, 2), libver="earliest", groups="pose 0:1, rest 1:2")
    write(folder / "headers.h5", record(3, 4, 2, 1), groups="pose 0:1")
    write(folder / "fixed-text.h5", record(2, 2, 3), groups=np.bytes_("pose 0:2, last 2:3"))
    write(folder / "list.h5", record(1, 3, 2, 2), groups=["pose 0:1", "rest 1:2"])
    write(folder / "latest.h5", record(2, 2, 2, 1), libver="latest")
    write(folder / "packed.h5", record(4, 3, 2, 1), compression=9, shuffle=True, fletcher32=True, chunks=True)
    write(folder / "singles.h5", {name: values.astype("f4") for name, values in record(3, 2, 2, 1).items()})
    write(folder / "one-run.h5", {name: values[0] for name, values in record(1, 5, 2, 2).items()})
    ragged = record(3, 4, 2, 2)
    ragged["error"][1, 2:] = np.nan
    ragged["innovation"][0, 1, 0] = np.nan
    ragged["covariance"][2, 1] = [[1, 1], [1, 1]]
    write(folder / "ragged.h5", ragged)


def write_second(folder):
    """Records with everything that is optional: a state that grows, parts without the whole, poses, rows in groups."""
    version = ("record_version", np.int32(2))
    grows = record(3, 4, 3, 2)
    grows["error"][:, :2, 2] = np.nan
    grows["covariance"][:, :2, 2, :] = grows["covariance"][:, :2, :, 2] = np.nan
    grows["time"] = np.arange(4) / 2
    write(folder / "second-grows.h5", grows, attributes=[
        version, ("groups", "outer 0 2, first 0"), ("row_groups", "gps 0, baro 1"),
        ("component_names", "x, y, z"), ("component_units", ["m", "m", "rad"])])
    variances = record(3, 2, 3)
    variances["covariance"] = np.full((3, 2, 3), 1.5)
    variances["steps"] = np.array([2, 1, 2], dtype=np.int32)
    write(folder / "second-variances.h5", variances, attributes=[version, ("groups", "pose 0:2")])
    parts = {"error": record(2, 2, 3)["error"],
             "group/pose/covariance": record(2, 2, 2)["covariance"].astype("f4"),
             "group/rest/nees": np.ones((2, 2))}
    write(folder / "second-parts.h5", parts,
          attributes=[version, ("groups", "pose 1 0, rest 2"), ("group/rest/nees/dimension", np.int32(1))])
    write(folder / "second-nees.h5", {"nees": np.ones((2, 3))}, attributes=[version, ("nees/dimension", np.int32(2))])
    poses = {name: np.zeros((2, 2, 8)) for name in ("truth", "estimate")}
    poses["truth"][..., 3] = poses["estimate"][..., 3] = 1
    poses["estimate"][..., 0] = 0.5
    poses["covariance"] = record(2, 2, 7)["covariance"]
    write(folder / "second-poses.h5", poses, attributes=[
        version, ("manifold", "SE3 x R1"), ("chart", "local"), ("quaternion", "wxyz")])
    plane = {name: np.full((1, 2, 4), 0.25) for name in ("truth", "estimate")}
    plane["covariance"] = record(1, 2, 4)["covariance"]
    write(folder / "second-plane.h5", plane, attributes=[version, ("manifold", "SE2 x SO2"), ("chart", "global")])
    turns = {name: np.full((3, 11), 0.5) for name in ("truth", "estimate")}
    turns["estimate"][:, :4] = [0.1, 0.1, 0.7, 0.7]
    turns["covariance"] = record(1, 3, 9)["covariance"][0].astype("f4")
    write(folder / "second-turns.h5", turns, attributes=[
        version, ("manifold", "SO3 x SE3"), ("chart", "global"), ("quaternion", "xyzw"), ("groups", "turn 0:3")])
    alone = {f"group/{name}/nees": np.ones((2, 3)) for name in ("pose", "rest")}
    alone["time"] = np.arange(6).reshape(2, 3) / 4
    write(folder / "second-alone.h5", alone, attributes=[
        version, ("group/pose/nees/dimension", 3.0), ("group/rest/nees/dimension", np.int8(2))])
    beside = {**record(3, 2, 2, 2), "nees": np.ones((3, 2)), "steps": np.array([2, 2, 1], dtype=np.uint8)}
    beside["group/one/covariance"] = beside.pop("covariance")[..., :1, :1]
    beside["error"][0, 1, 1] = beside["nees"][0, 1] = beside["innovation"][1, 1, 0] = np.nan
    write(folder / "second-beside.h5", beside, attributes=[
        version, ("groups", "one 0"), ("row_groups", "gps 1, baro 0"), ("nees/dimension", np.int32(2))])


def main(results, seeds):
    for path in sorted(results.glob("*.h5")):
        copy_results(path, seeds / "results" / path.name, ("v108", "v108"))
    copy_results(results / "heading.h5", seeds / "results" / "earliest.h5", ("earliest", "v108"))
    copy_results(results / "heading.h5", seeds / "results" / "checksums.h5", ("v108", "v108"), FOR_OTHERS)
    write_noise(seeds / "noise")
    write_judge(seeds / "judge")
    write_second(seeds / "judge")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
