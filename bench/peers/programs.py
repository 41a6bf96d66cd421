"""Asks other programs about lobe's models and files, and prints what they say beside lobe as a page of documentation.

usage: programs.py LOBE DATA

LOBE is the command, DATA the folder with measured files, or "" for none. Needs what script/check-peers installs of PyPI, and
an LLVM that Dr.Jit takes (DRJIT_LIBLLVM_PATH). script/check-peers calls it.
"""

import datetime
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile
import time

import drjit as dr
import h5py
import mitsuba as mi
import netCDF4
import numpy as np
import OpenEXR
import png
import PyOpenColorIO as ocio
import pyradiance
from pyradiance import bsdf as radiance_bsdf

LOBE, DATA = sys.argv[1], sys.argv[2]
PAIRS = 2000
SAMPLES = 1_000_000
mi.set_variant("llvm_ad_rgb")


def lobe(*arguments):
    done = subprocess.run([LOBE, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"lobe {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def unit(theta, phi):
    return np.c_[np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]


class Pairs:
    """Random pairs of directions with cosines from 0.1 on, of light (i) and view (o)."""

    def __init__(self, seed, count=PAIRS, least=0.1):
        rng = np.random.default_rng(seed)
        self.theta_i, self.theta_o = (np.arccos(rng.uniform(least, 1, count)) for _ in range(2))
        self.phi_i, self.phi_o = (rng.uniform(0, 2 * np.pi, count) for _ in range(2))
        self.i, self.o = unit(self.theta_i, self.phi_i), unit(self.theta_o, self.phi_o)
        self.count = count

    def of_lobe(self, material):
        """Values by pair and channel, in 1/sr."""
        columns = np.c_[self.theta_i, self.phi_i, self.theta_o, self.phi_o]
        np.save("pairs.npy", np.degrees(columns))
        lobe("eval", material, "--pairs", "pairs.npy", "--output", "values.npy", "--force", "--quiet")
        return np.load("values.npy").reshape(self.count, -1)

    def of_mitsuba(self, bsdf):
        interaction = dr.zeros(mi.SurfaceInteraction3f, self.count)
        interaction.wi = mi.Vector3f(self.i.T)
        values = np.array(bsdf.eval(mi.BSDFContext(), interaction, mi.Vector3f(self.o.T)))
        return values.T / self.o[:, 2:3]  # Mitsuba's have the cosine

    def of_radiance(self, data):
        """Values of the luminance."""
        values = [
            radiance_bsdf.query(data, *angles)[1]
            for angles in np.degrees(np.c_[self.theta_i, self.phi_i, self.theta_o, self.phi_o])
        ]
        return np.array(values)[:, None]


def differences(mine, theirs):
    """Largest difference by the largest value, and largest and median relative one where values are above a thousandth."""
    if mine.shape[1] == 1:
        theirs = theirs[:, :1]
    difference = np.abs(mine - theirs)
    seen = mine > 1e-3 * mine.max()
    relative = (difference[seen] / mine[seen]) if seen.any() else np.zeros(1)
    return f"{difference.max() / mine.max():.1e} | {relative.max():.1e} | {np.median(relative):.1e}"


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def head(*cells):
    row(*cells)
    print("|" + "---|" * len(cells))


def code(text):
    return f"`{text}`"


def grey(value):
    return {"type": "rgb", "value": value}


def models():
    print(
        "\n## Mitsuba's models\n\nMitsuba evaluates its own plugins in single precision, lobe its models in double, at "
        f"{PAIRS} random pairs of directions. Differences are divided by the largest value, then by each value that is "
        "above a thousandth of the largest.\n"
    )
    head("Mitsuba", "lobe", "of the largest", "relative, largest", "median")
    cases = [
        ("diffuse", {"reflectance": grey(1.0)}, "lambert"),
        *(
            case
            for a in (0.1, 0.3, 0.8)
            for case in (
                ("roughconductor", {"distribution": "ggx", "alpha": a, "material": "none"}, f"ggx_separable:alpha={a}"),
                ("roughconductor", {"distribution": "beckmann", "alpha": a, "material": "none"},
                 f"beckmann_separable:m={a}"),
            )
        ),
        ("roughconductor", {"distribution": "ggx", "alpha": 0.3, "eta": grey(0.2), "k": grey(3.9)},
         "ggx_separable:alpha=0.3*fresnel:ior=0.2,k=3.9"),
        ("principled", {"base_color": grey(1.0), "roughness": 0.5, "specular": 0.0}, "disney_diffuse:rough=0.5"),
        ("principled", {"base_color": grey(1.0), "roughness": 0.5, "metallic": 1.0}, "ggx_separable:alpha=0.25"),
        ("principled", {"base_color": grey(0.0), "specular": 0.0, "sheen": 1.0}, "disney_sheen"),
    ]
    pairs = Pairs(1)
    for plugin, parameters, material in cases:
        told = ", ".join(f"{k} {v['value'] if isinstance(v, dict) else v}" for k, v in parameters.items())
        bsdf = mi.load_dict({"type": plugin, **parameters})
        row(f"`{plugin}` ({told})", code(material), differences(pairs.of_lobe(material), pairs.of_mitsuba(bsdf)))


    print("\nMitsuba has a rational function for Smith's attenuation of Beckmann's facets (Walter et al. 2007), which is off by up to "
          "0.35 % on either side.")


def sampled_albedo(bsdf, theta):
    """Albedo of light from an angle as the mean weight of Mitsuba's samples, and its standard deviation."""
    interaction = dr.zeros(mi.SurfaceInteraction3f, SAMPLES)
    interaction.wi = mi.Vector3f(float(np.sin(theta)), 0, float(np.cos(theta)))
    rng = mi.PCG32(SAMPLES)
    first = rng.next_float32()
    second = mi.Point2f(rng.next_float32(), rng.next_float32())
    _, weights = bsdf.sample(mi.BSDFContext(), interaction, first, second)
    values = np.array(weights).T.reshape(SAMPLES, -1)[:, 0]
    counted = values[np.isfinite(values)]
    told = f"{counted.mean():.5f} ± {counted.std() / np.sqrt(len(counted)):.1g}"
    lost = SAMPLES - len(counted)
    return told if lost == 0 else f"{told}, without {lost} that are no numbers"


def tensor_files():
    print(
        "\n## RGL's tensor files\n\nMitsuba's `measured` loads what `lobe export --format rgl` writes; lobe reads the same "
        "file. The last columns are albedos at 45 degrees, of the file by lobe and by Mitsuba's own sampling with "
        "a million samples, with one standard deviation.\n"
    )
    head("file", "of the largest", "relative, largest", "median", "albedo by lobe", "by Mitsuba's samples")
    pairs = Pairs(2)
    files = []
    for material in ("ggx_separable:alpha=0.3", "ward:m=0.2,scale=0.5", "lambert:scale=0.5/0.3/0.1+phong:n=30,scale=0.2",
                     "ggx_anisotropic:alpha_x=0.2,alpha_y=0.5", "hapke:w=0.6,b=0.2,c=0.3,b0=0.5,h=0.1,theta_bar=0.3"):
        name = f"{len(files)}.bsdf"
        lobe("export", material, "--format", "rgl", "--output", name, "--force", "--quiet")
        files.append((f"`{material}`", name))
    if DATA:
        files += [(path.name, str(path)) for path in sorted(pathlib.Path(DATA, "rgl_bsdf").glob("*_rgb.bsdf"))]
    for told, name in files:
        bsdf = mi.load_dict({"type": "measured", "filename": name})
        mine = pairs.of_lobe(name)
        albedo = re.search(r"^\s*45\s+(.*)$", lobe("albedo", name, "--theta", "45", "--quiet"), re.M)
        row(told, differences(mine, pairs.of_mitsuba(bsdf)), albedo.group(1).split("  ")[0] if albedo else "",
            sampled_albedo(bsdf, np.pi / 4))


def radiance_program(name, *arguments, feed=None):
    folder = pathlib.Path(pyradiance.__file__).parent
    environment = {**os.environ, "RAYPATH": f".:{folder / 'lib'}"}
    return subprocess.run([str(folder / "bin" / name), *arguments], input=feed, capture_output=True, check=True,
                          env=environment).stdout


def radiance_albedo(name, angles):
    """Radiance that a patch of this material sends towards an eye at these angles under a sky of radiance 1."""
    pathlib.Path("furnace.rad").write_text(
        f"void BSDF m\n6 0 {name} 0 1 0 .\n0\n0\nm polygon p\n0\n0\n12 -1 -1 0 1 -1 0 1 1 0 -1 1 0\n"
        "void glow g\n0\n0\n4 1 1 1 0\ng source sky\n0\n0\n4 0 0 1 180\n"
    )
    pathlib.Path("furnace.oct").write_bytes(radiance_program("oconv", "furnace.rad"))
    rays = "".join(f"{2 * np.sin(t)} 0 {2 * np.cos(t)} {-np.sin(t)} 0 {-np.cos(t)}\n" for t in np.radians(angles))
    told = radiance_program("rtrace", "-h", "-ab", "1", "-ad", "4096", "-lw", "1e-6", "-ss", "0", "furnace.oct",
                            feed=rays.encode())
    return [float(line.split()[1]) for line in told.decode().splitlines()]


def radiance_files():
    print(
        "\n## Files for Radiance\n\nRadiance reads what `lobe export` writes as `klems` and as `tensor-tree`. Values at random "
        "pairs are those of its library; albedos those that `rtrace` finds for a surface in a white furnace; the last column is "
        "what its `checkBSDF` says of both directions of light.\n"
    )
    angles = [0, 31, 60]
    head("file", "of the largest", "relative, largest", "median", "albedos at 0, 31, 60 degrees by lobe", "by `rtrace`",
         "largest albedo and mean reciprocity error by `checkBSDF`")
    pairs = Pairs(4)
    materials = ("ward:m=0.4,scale=0.5", "ggx:alpha=0.1", "lambert:scale=0.5+phong:n=30,scale=0.2",
                 "ggx_anisotropic:alpha_x=0.2,alpha_y=0.5")
    files = [(form, material) for form in ("klems", "tensor-tree") for material in materials]
    loaded = []  # else pyradiance frees files that Radiance still lists, and loops forever
    for k, (form, material) in enumerate(files):
        name = f"file{k}.xml"  # Radiance keeps files by name
        lobe("export", material, "--format", form, "--output", name, "--force", "--quiet")
        data = radiance_bsdf.load_file(name)
        loaded.append(data)
        listed = ",".join(str(angle) for angle in angles)
        mine = re.findall(r"^\s*(?:0|31|60)\s+(\S+)", lobe("albedo", name, "--theta", listed, "--quiet"), re.M)
        theirs = radiance_albedo(name, angles)
        check = radiance_program("checkBSDF", name).decode()
        most = re.search(r"^Interior Refl\s.*?([\d.]+)%\s+[\d.]+ deg", check, re.M)
        error = re.search(r"Reciprocity Error.*\nInterior Refl\s+[\d.]+\s+([\d.]+)", check)
        row(f"{form}, `{material}`", differences(pairs.of_lobe(name), pairs.of_radiance(data)),
            ", ".join(f"{float(value):.6f}" for value in mine), ", ".join(f"{value:.6f}" for value in theirs),
            f"{most.group(1)} %, {error.group(1)} %" if most and error else "")


def columns_of_exr(name):
    channels = OpenEXR.File(name, separate_channels=True).channels()
    order = {"Y": 0, "R": 0, "G": 1, "B": 2}
    return np.stack([channels[key].pixels for key in sorted(channels, key=order.get)], axis=-1)


def columns_of_png(name):
    _, _, rows, info = png.Reader(filename=name).read()
    values = np.array([np.array(row) for row in rows], dtype=float) / (2 ** info["bitdepth"] - 1)
    return values.reshape(len(values), -1, info["planes"])


def columns_of_netcdf(name):
    with netCDF4.Dataset(name) as data:
        values = [data[column][:] for column in ("scale", "bias") if column in data.variables]
        return np.stack(values or [data["albedo"][:]], axis=-1)


def columns_of_hdf5(name):
    with h5py.File(name) as data:
        values = [data[column][:] for column in ("scale", "bias") if column in data]
        return np.stack(values or [data["albedo"][:]], axis=-1)


def columns_of_spi1d(name, count):
    # OpenColorIO interpolates linearly between the entries, which are nodes from 0 to 1.
    transform = ocio.FileTransform(src=name, interpolation=ocio.INTERP_LINEAR)
    processor = ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor()
    return np.array([[processor.applyRGB([u, u, u])[0]] for u in np.linspace(0, 1, count)])


def tables():
    print(
        "\n## Tables of albedos\n\nWhat `lobe lut` writes, read by other programs: the largest difference from the same table in "
        "double precision (`.npy`), beside the error of entries that the command states. `ggx:alpha=1` over `alpha:map=sqrt` and "
        "`cos_theta`, split in f0, 32 x 32; for OpenColorIO one curve of 33 nodes.\n"
    )
    head("file", "read by", "difference", "stated error of entries")
    split = ("ggx:alpha=1,f0=1", "--axis", "alpha:map=sqrt", "--axis", "cos_theta", "--split", "f0")
    curve = ("ggx:alpha=0.5,f0=1", "--axis", "cos_theta:count=33,entries=nodes")
    cases = [
        ("NPY", "NumPy", "t.npy", split, (), np.load),
        ("HDF5", "h5py", "t.h5", split, (), columns_of_hdf5),
        ("HDF5", "netCDF4", "t.h5", split, (), columns_of_netcdf),
        ("PNG, 16 bits", "pypng", "t.png", split, (), columns_of_png),
        ("PNG, 8 bits", "pypng", "t8.png", split, ("--bits", "8"), columns_of_png),
        ("OpenEXR, 32 bits", "OpenEXR", "t.exr", split, (), columns_of_exr),
        ("OpenEXR, 16 bits", "OpenEXR", "t16.exr", split, ("--bits", "16"), columns_of_exr),
        ("spi1d", "OpenColorIO", "t.spi1d", curve, (), lambda name: columns_of_spi1d(name, 33)),
    ]
    exact = {}
    for told, reader, name, request, options, columns in cases:
        if request not in exact:
            lobe("lut", *request, "--output", "exact.npy", "--force", "--quiet")
            exact[request] = np.load("exact.npy")
        said = lobe("lut", *request, "--output", name, "--force", "--quiet", *options)
        stated = re.search(r"error of entries\s+(\S+)", said).group(1)
        count = 2 if request is split else 1  # pictures may have a channel more
        found = np.asarray(columns(name), dtype=float)[..., :count].reshape(exact[request].shape)
        row(told, reader, f"{np.abs(found - exact[request]).max():.1e}", stated)


def best_of(function, rounds=3):
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        function()
        times.append(time.perf_counter() - begin)
    return min(times)


def ggx(wi, wo, alpha, real):
    """GGX with separable Smith attenuation and F = 1, in 1/sr."""
    half = dr.normalize(wi + wo)
    squared = alpha * alpha
    root = half.z * half.z * (squared - 1) + 1
    facets = squared / (np.pi * root * root)

    def masking(cosine):
        return 1 / (cosine + dr.sqrt(squared + (1 - squared) * cosine * cosine))

    return real(facets * masking(wi.z) * masking(wo.z))


def speed():
    count = 10_000_000
    print(
        "\n## Speed\n\nGGX with α = 0.3 at ten million pairs of directions, from angles in a file of NumPy to values in another, best of three. "
        "Mitsuba and Dr.Jit (LLVM) are timed in a running Python, lobe as a command with its start.\n"
    )
    pairs = Pairs(5, count)
    np.save("many.npy", np.degrees(np.c_[pairs.theta_i, pairs.phi_i, pairs.theta_o, pairs.phi_o]))
    bsdf = mi.load_dict({"type": "roughconductor", "distribution": "ggx", "alpha": 0.3, "material": "none"})

    def vectors(real, vector):
        angles = np.radians(np.load("many.npy"))
        theta_i, phi_i, theta_o, phi_o = (real(np.ascontiguousarray(angles[:, k])) for k in range(4))

        def direction(theta, phi):
            sine, cosine = dr.sincos(theta)
            sin_phi, cos_phi = dr.sincos(phi)
            return vector(sine * cos_phi, sine * sin_phi, cosine)

        return direction(theta_i, phi_i), direction(theta_o, phi_o)

    def mitsuba():
        wi, wo = vectors(mi.Float, mi.Vector3f)
        interaction = dr.zeros(mi.SurfaceInteraction3f, count)
        interaction.wi = wi
        np.save("out.npy", np.array(bsdf.eval(mi.BSDFContext(), interaction, wo)[0] / wo.z))

    def drjit(real, vector):
        wi, wo = vectors(real, vector)
        np.save("out.npy", np.array(ggx(wi, wo, 0.3, real)))

    def command(*precision):
        lobe("eval", "ggx_separable:alpha=0.3", "--pairs", "many.npy", "--output", "out.npy", "--force", "--quiet", *precision)

    head("", "single precision, s", "double precision, s")
    row("lobe", f"{best_of(lambda: command('--precision', 'single')):.2f}", f"{best_of(command):.2f}")
    row("Mitsuba", f"{best_of(mitsuba):.2f}", "")
    from drjit.llvm import Array3f, Array3f64, Float32, Float64  # pylint: disable=import-outside-toplevel

    row("Dr.Jit", f"{best_of(lambda: drjit(Float32, Array3f)):.2f}", f"{best_of(lambda: drjit(Float64, Array3f64)):.2f}")


def main():
    print("# Other programs as clients\n")
    print("Written by `script/check-peers`, which is no part of building, running or testing.\n")
    head("", "")
    row("date", datetime.date.today().isoformat())
    row("lobe", lobe("--version").splitlines()[0])
    row("Mitsuba", f"{mi.__version__} (PyPI), variant {mi.variant()}, Dr.Jit {dr.__version__}")
    row("Radiance", radiance_program("rtrace", "-defaults") and
        re.search(r"RADIANCE (\S+)", radiance_version()).group(1) + f" (pyradiance {pyradiance.__version__} of PyPI)")
    row("system", platform.platform())
    models()
    tensor_files()
    radiance_files()
    tables()
    speed()
    sys.stdout.flush()
    os._exit(0)  # pyradiance frees its files twice


def radiance_version():
    return radiance_program("rtrace", "-version").decode()


if __name__ == "__main__":
    LOBE, DATA = os.path.abspath(LOBE), os.path.abspath(DATA) if DATA else ""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        main()
