"""Scenes with published pictures, how they are rendered to be compared, and what is known of their differences."""

from dataclasses import dataclass, field


@dataclass
class Scene:
    file: str  # below the folder of validation data
    reference: str
    variance: str = ""  # of one sample of the reference; "": not known
    options: list = field(default_factory=list)  # of `etendue render`
    size: tuple = ()  # of the render, when it is not the reference's
    tile: int = 8  # [pixels of the reference]
    skip_above: float = 0.0  # tiles with a brighter pixel [Y] hold the edge of a light; 0: none is left out
    samples: int = 0  # a pixel, at least
    quick: bool = False  # also in the short run of the test suite
    reason: str = ""  # why the picture differs; "" when it must agree
    # What the reason explains: by how much of it the reference's X, Y and Z are changed before they are compared, and how many
    # tiles may be beyond their bound. What goes beyond that is not explained, and fails as any other difference.
    explained: tuple = (0.0, 0.0, 0.0)
    explained_tiles: int = 0


MITSUBA = "mitsuba/tests/scenes/"
BETWEEN_TEXELS = (
    "between two texels of its surroundings, `museum.exr`, Mitsuba's spectral variants blend colour and brightness apart, which takes blue "
    "from them: where the camera sees nothing else, Z is -0.63 % of its own llvm_ad_rgb's, and Étendue's is +0.06 %. With each texel repeated "
    "8 x 8 times, so that there is little between them, the pictures agree with "
    "llvm_ad_spectral of Mitsuba 3.9.1 in X, Y and Z within +0.09, +0.10, +0.24 % (test_hetero_sigmat; standard error 0.11 to 0.14 %), -0.02, "
    "+0.01, +0.04 % (test_homo_null_envmap; 0.06 to 0.10 %) and +0.10, +0.11, +0.17 % (test_surf_area_light; 0.11 to 0.13 %).")


def mitsuba(path, **more):
    folder, file = path.rsplit("/", 1)
    name = file.rsplit("_", 1)[0]
    references = f"{MITSUBA}{folder}/refs/{name}_ref_spectral"
    return Scene(f"{MITSUBA}{path}.xml", f"{references}.exr", f"{references}_var.exr", **more)


def bitterli(name, width, height, depth, sets=(), **more):
    options = [word for one in (f"renderer.max_depth={depth}", *sets) for word in ("--set", one)]
    return Scene(f"bitterli/{name}/scene.xml", f"bitterli/{name}/TungstenRender.exr", size=(width // 4, height // 4), tile=64,
                 options=options, **more)


SCENES = [
    mitsuba("bsdf_spheres/test_arealight_path"),
    mitsuba("bsdf_spheres/test_constant_path", quick=True),
    mitsuba("bsdf_spheres/test_envmap_path", explained=(0, 0, 0.0025), explained_tiles=2, reason=BETWEEN_TEXELS),
    mitsuba("bsdf_spheres/test_normalmap_identity_roughconductor_path", explained=(0, 0, 0.0025), explained_tiles=2,
            reason=BETWEEN_TEXELS),
    mitsuba("bsdf_spheres/test_pointlight_path"),
    mitsuba("bsdf_spheres/test_roughplastic_linear_path"),
    mitsuba("bsdf_spheres/test_textured_diffuse_path", quick=True, explained=(0, 0, 0.0025), explained_tiles=2, reason=BETWEEN_TEXELS),
    mitsuba("floating_sphere/test_directional_direct", quick=True),
    mitsuba("infinite_mirrors/scene_path"),
    mitsuba("instancing/test_instancing_path", quick=True),
    mitsuba("mesh_attributes/test_mesh_attributes_1_face_direct"),
    mitsuba("mesh_attributes/test_mesh_attributes_3_vertex_direct", quick=True),
    mitsuba("orthographic_sensor/test_orthographic_path", quick=True),
    mitsuba("participating_media/test_hetero_sigmat_volpath", explained=(0, 0, 0.0075), reason=BETWEEN_TEXELS),
    # Behind the two bodies few paths bring much: of few samples a tile is dark, and does not know how uncertain it is.
    mitsuba("participating_media/test_homo_area_light_volpath", samples=1200),
    mitsuba("participating_media/test_homo_null_envmap_volpath", explained=(0, 0, 0.0075), reason=BETWEEN_TEXELS),
    mitsuba("participating_media/test_surf_area_light_volpath"),
    mitsuba("spot_light/test_spot_direct"),
    mitsuba("texture_interp/test_texture_interp_direct"),
    bitterli("cornell-box", 1024, 1024, 64, skip_above=2, explained=(-0.0083, -0.0066, -0.0281), explained_tiles=80,
             reason="the reference is made of red, green and blue, and colours multiply otherwise as spectra where saturated light "
             "(17, 12, 4) meets red and green walls several times. Mitsuba 3.9 has the same difference between its variants: means of "
             "X, Y, Z of 0.1331, 0.1356, 0.0533 with llvm_ad_rgb (the reference: 0.1331, 0.1355, 0.0533) and of 0.1320, 0.1346, 0.0518 "
             "with llvm_ad_spectral (here: 0.1320, 0.1346, 0.0519)."),
    bitterli("veach-mis", 1280, 720, 2, skip_above=8),
    bitterli("material-testball", 1280, 720, 64,
             sets=["scene.objects[0].shader.color.map.first=rgb(0.325, 0.31, 0.25)",
                   "scene.objects[0].shader.color.map.second=rgb(0.725, 0.71, 0.68)"],
             explained=(-0.022, -0.015, -0.005), explained_tiles=56,
             reason="two things, both of the coated copper; floor and surroundings agree within 0.5 %. The reference is made of red, "
             "green and blue, and the coat's absorption (0.5, 1, 2.5 on the way down) cuts narrower bands out of spectra: the body is 17, "
             "6 and 7 % darker in R, G and B; with each channel's constants as flat spectra it is +0.6, -4.8 and +1.6 %. What is left, "
             "-9 % of green where the coat is seen, is copper under a coat of index 1.7, where it reflects 51 % of green straight on, "
             "and not 62 % as beside air, which Tungsten computes: with an index 1.7 times as large green is +0.7 %. (The floor has the "
             "two colours of the checkerboard exchanged, since Tungsten's rectangle counts v the other way and 20 squares turned over "
             "change places; they are exchanged for the comparison.)"),
    bitterli("staircase2", 1024, 1024, 64, skip_above=10, explained=(-0.011, -0.0083, -0.0106),
             reason="two things. Mitsuba 3.9's llvm_ad_rgb, to which the file's colours are what "
             "they are to Tungsten, is itself 0.56, 0.39 and 0.13 % darker in R, G and B (512 samples), its floor of rough plastic, whose "
             "losses are imported as they are there, 2 to 3 %. And colours as spectra take 0.6 % in many bounces: "
             "llvm_ad_rgb is that much brighter than the picture here."),
]

# What is known of the other way, exports.py.
EXPORTS = (
    "Of the parts of `tests/references/exports/metals.etd` gold, copper and plastic agree with Mitsuba 3.9 within 0.09 % (standard error "
    "0.04 %), of which 0.06 % are everywhere. A mixture that holds a smooth mirror does not: a sphere of 65 % Lambertian (0.5) and 35 % "
    "mirror (0.9) under an even sky of 1 returns 0.65 * 0.5 + 0.35 * 0.9 = 0.64, which is 0.640 here and 0.592 in Mitsuba, in either order, "
    "one-sided or not, though each of the two alone is right there (0.501 and 0.901). That was the whole of the difference of -0.66 % that the "
    "scene once had; its mixture holds a rough mirror, and agrees within 0.02 % (standard error 0.05 %).")
