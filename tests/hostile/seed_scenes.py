"""Right scenes of Mitsuba and pbrt which together use every kind of thing that the importers know.

`mitsuba_scenes()` and `pbrt_scenes()` give (what it is, text); `beside()` gives the files that they name, all but the measured
material "brdf.bsdf".
"""
import pathlib
import struct
import zlib

import seed_images


def serialized_mesh(version=4, flags=0x1001):
    """Two meshes of one triangle each, as Mitsuba 0.5 writes them. Flags: 1 normals, 2 uvs, 8 colours, 16 faceted, 0x1000 floats,
    0x2000 doubles."""
    kind = "d" if flags & 0x2000 else "f"
    body = struct.pack("<I", flags) + (b"name\0" if version == 4 else b"") + struct.pack("<QQ", 3, 1)
    body += struct.pack(f"<9{kind}", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    body += struct.pack(f"<9{kind}", *[0, 0, 1] * 3) if flags & 1 else b""
    body += struct.pack(f"<6{kind}", 0, 0, 1, 0, 0, 1) if flags & 2 else b""
    body += struct.pack(f"<9{kind}", *[0.2, 0.4, 0.6] * 3) if flags & 8 else b""
    part = struct.pack("<HH", 0x041C, version) + zlib.compress(body + struct.pack("<3I", 0, 1, 2))
    return part * 2 + struct.pack("<QQI" if version == 4 else "<III", 0, len(part), 2)


def volume(channels, encoding=1):
    """A cloud of 3 x 2 x 2 cells in Mitsuba's format, its numbers floats (1) or bytes (3)."""
    count = 12 * channels
    header = b"VOL\3" + struct.pack("<5i6f", encoding, 3, 2, 2, channels, -1, -1, -1, 1, 1, 1)
    return header + (struct.pack(f"<{count}f", *((i % 5) / 4 for i in range(count))) if encoding == 1 else bytes(range(count)))


def nanovdb():
    """One grid of a file that OpenVDB's nanovdb_convert wrote, no longer compressed, so that damage gets behind the checksum."""
    data = (pathlib.Path(__file__).parent.parent / "volumes" / "rounded_fp8.nvdb").read_bytes()
    entry = data[16:16 + 176 + struct.unpack_from("<I", data, 16 + 136)[0]]
    body = zlib.decompress(data[16 + len(entry) + 8:])
    return data[:14] + b"\0\0" + entry[:8] + struct.pack("<Q", len(body)) + entry[16:] + body


OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"
PLY = (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float vertex_mark\n"
       b"element face 1\nproperty list uchar int vertex_indices\nproperty float face_tone\nend_header\n"
       b"0 0 0 .1\n1 0 0 .2\n0 1 0 .3\n3 0 1 2 .5\n")


def square_picture():
    def piece(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + b"".join(bytes([40 * y, 60 * x, 99]) for x in range(4)) for y in range(4))
    return b"\x89PNG\r\n\x1a\n" + piece(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)) + piece(b"IDAT", zlib.compress(rows)) + piece(b"IEND", b"")


def beside():
    picture = next(data for name, ending, data in seed_images.small_images() if ending == "png")
    return {"picture.png": picture, "square.png": square_picture(), "mesh.obj": OBJ, "mesh.ply": PLY, "mesh.serialized": serialized_mesh(), "cloud.vol": volume(1),
            "colours.vol": volume(3), "smoke.nvdb": nanovdb(), "paint.spd": b"400 0.3\n500 0.7\n700 0.1\n", "fibres.txt": b"0 0 0 .1\n1 0 0 .1\n1 1 0 .1\n1 1 1 .1\n"}


# ---- Mitsuba --------------------------------------------------------------------------------------------------------------

MITSUBA = """<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <default name="spp" value="4"/> <default name="kind" value="path"/>
  <integrator type="$kind"><integer name="max_depth" value="5"/></integrator>
  <sensor type="thinlens"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/>
    <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="3"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0 0 0" up="0 1 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/><rfilter type="mitchell"/></film>
    <sampler type="multijitter"><integer name="sample_count" value="$spp"/></sampler></sensor>
  <bsdf type="twosided" id="paint"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.1 0.2 0.3"/><spectrum name="color1" value="400:0.1, 500:0.8, 700:0.4"/>
    <transform name="to_uv"><scale x="3" y="4"/><rotate z="1" angle="30"/></transform></texture></bsdf></bsdf>
  <alias id="paint" as="colour"/>
  <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="#102030"/><phase type="hg"><float name="g" value="0.3"/></phase></medium>
  <shape type="shapegroup" id="group"><shape type="sphere"><point name="center" x="1"/><ref id="colour"/></shape>
    <shape type="cube"><bsdf type="roughplastic"><string name="distribution" value="ggx"/></bsdf></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><matrix value="1 0 0 0 0 2 0 1 0 0 1 0 0 0 0 1"/></transform></shape>
  <shape type="rectangle"><bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="roughconductor">
    <string name="material" value="Au"/></bsdf></bsdf></shape>
  <shape type="cylinder"><bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf><ref name="interior" id="fog"/></shape>
  <emitter type="spot"><rgb name="intensity" value="5"/></emitter> <emitter type="constant"/>
</scene>
"""

MITSUBA_OLD = """<scene version="0.5.0"><integrator type="volpath"><integer name="maxDepth" value="65"/></integrator>
  <sensor type="perspective"><float name="fov" value="70"/><transform name="toWorld"><matrix value="-1 0 0 6 0 1 0 1 0 0 -1 2 0 0 0 1"/>
    </transform><film type="ldrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><float name="gamma" value="2.2"/>
    <boolean name="banner" value="false"/></film></sensor>
  <bsdf type="mixturebsdf" id="mix"><string name="weights" value="0.3, 0.5"/><bsdf type="phong"><float name="exponent" value="10"/></bsdf>
    <bsdf type="coating"><rgb name="sigmaA" value="0.1"/><bsdf type="conductor"><rgb name="eta" value="1 2 3"/><rgb name="k" value="3"/>
    </bsdf></bsdf></bsdf>
  <shape type="disk"><ref id="mix"/><emitter type="area"><srgb name="radiance" value="#ffcc00"/></emitter></shape></scene>
"""

SURFACES = """<scene version="3.5.0"><sensor type="perspective"><float name="focal_length" value="35"/><float name="near_clip" value="1"/></sensor>
  <shape type="merge"><shape type="obj"><string name="filename" value="mesh.obj"/><boolean name="face_normals" value="true"/>
    <bsdf type="principled"><rgb name="base_color" value=".5"/><float name="metallic" value=".3"/><float name="spec_trans" value=".2"/>
      <texture type="bitmap" name="roughness"><string name="filename" value="picture.png"/><boolean name="raw" value="true"/>
      <string name="filter_type" value="nearest"/><string name="wrap_mode" value="mirror"/></texture></bsdf></shape></shape>
  <shape type="ply"><string name="filename" value="mesh.ply"/><boolean name="flip_normals" value="true"/>
    <bsdf type="blendbsdf"><texture type="mesh_attribute" name="weight"><string name="name" value="face_tone"/></texture>
      <bsdf type="diffuse"/><bsdf type="principledthin"><float name="diff_trans" value=".7"/></bsdf></bsdf></shape>
  <shape type="serialized"><string name="filename" value="mesh.serialized"/><integer name="shape_index" value="1"/>
    <bsdf type="normalmap"><texture type="bitmap" name="normalmap"><string name="filename" value="picture.png"/></texture>
      <bsdf type="roughconductor"><float name="alpha_u" value=".1"/><float name="alpha_v" value=".3"/></bsdf></bsdf></shape>
  <shape type="bsplinecurve"><string name="filename" value="fibres.txt"/><bsdf type="hair"><float name="eumelanin" value=".2"/></bsdf></shape>
  <shape type="sphere"><float name="radius" value="2"/><bsdf type="bumpmap"><texture type="checkerboard"/>
    <float name="scale" value="2"/><bsdf type="roughdielectric"><float name="int_ior" value="1.5"/><float name="alpha" value=".2"/></bsdf>
    </bsdf></shape>
  <shape type="disk"><bsdf type="plastic"><rgb name="diffuse_reflectance" value=".1 .2 .3"/><boolean name="nonlinear" value="true"/></bsdf></shape>
  <shape type="rectangle"><bsdf type="thindielectric"/></shape> <shape type="cylinder"><point name="p0" value="0 0 0"/>
    <point name="p1" x="0" y="1" z="2"/><bsdf type="null"/></shape>
  <shape type="cube"><bsdf type="measured"><string name="filename" value="brdf.bsdf"/></bsdf></shape>
  <shape type="sphere"><bsdf type="conductor"><spectrum name="eta" value="300:.2, 900:.4"/><spectrum name="k" filename="paint.spd"/>
    <texture type="scale" name="specular_reflectance"><float name="scale" value=".5"/><texture type="bitmap">
    <string name="filename" value="picture.png"/></texture></texture></bsdf></shape>
</scene>
"""

LIGHTS = """<scene version="3.0.0"><path value="."/><sensor type="orthographic"><transform name="to_world"><scale value="3"/><translate z="-5"/>
    </transform><float name="shutter_close" value="1"/><film type="hdrfilm"><integer name="crop_width" value="2"/>
    <integer name="crop_height" value="2"/><string name="file_format" value="rgbe"/><rfilter type="gaussian"><float name="stddev" value=".5"/>
    </rfilter></film></sensor>
  <integrator type="aov"><string name="aovs" value="a:depth"/><integrator type="direct"><integer name="bsdf_samples" value="2"/></integrator>
  </integrator>
  <emitter type="point"><point name="position" value="0,1,2"/><spectrum name="intensity" value="3"/></emitter>
  <emitter type="spot"><texture type="bitmap" name="texture"><string name="filename" value="picture.png"/></texture>
    <float name="cutoff_angle" value="30"/><float name="beam_width" value="20"/></emitter>
  <emitter type="projector"><texture type="bitmap" name="irradiance"><string name="filename" value="picture.png"/></texture>
    <float name="fov" value="30"/></emitter>
  <emitter type="directional"><vector name="direction" value="0 -1 1"/><rgb name="irradiance" value="2"/></emitter>
  <emitter type="envmap"><string name="filename" value="picture.png"/><float name="scale" value="2"/>
    <transform name="to_world"><rotate y="1" angle="90"/></transform></emitter>
  <emitter type="sunsky"><float name="turbidity" value="3"/><vector name="sun_direction" value="0 1 1"/></emitter>
  <medium type="heterogeneous" id="smoke"><volume type="gridvolume" name="sigma_t"><string name="filename" value="cloud.vol"/>
    <transform name="to_world"><translate x="1"/><scale x="2" y="3" z="4"/></transform></volume><float name="scale" value="5"/>
    <volume type="gridvolume" name="albedo"><string name="filename" value="colours.vol"/></volume><phase type="isotropic"/></medium>
  <shape type="cube"><bsdf type="null"/><ref name="interior" id="smoke"/></shape>
  <shape type="sphere"><emitter type="area"><spectrum type="blackbody" name="radiance"><float name="temperature" value="4000"/></spectrum>
    </emitter><medium name="interior" type="homogeneous"><rgb name="albedo" value=".9"/><float name="sigma_t" value="2"/></medium></shape>
  <shape type="rectangle"><emitter type="area"><spectrum type="irregular" name="radiance"><string name="wavelengths" value="400, 700"/>
    <string name="values" value="1, 2"/></spectrum></emitter></shape>
  <shape type="disk"><emitter type="area"><spectrum type="regular" name="radiance"><float name="wavelength_min" value="400"/>
    <float name="wavelength_max" value="700"/><string name="values" value="1, 2, 3"/></spectrum></emitter></shape>
</scene>
"""

OLDEST = """<scene version="0.4.0"><integrator type="bdpt"/><camera type="thinlens"><float name="focusDistance" value="2"/>
    <float name="apertureRadius" value=".1"/><animation name="toWorld"><transform time="0"><translate x="1"/></transform>
    <transform time="1"><translate x="2"/></transform></animation><film type="exrfilm"/><sampler type="ldsampler"/></camera>
  <bsdf type="lambertian" id="a"><rgb name="reflectance" value=".3"/></bsdf>
  <bsdf type="composite" id="b"><string name="weights" value=".5 .5"/><ref id="a"/><bsdf type="ward"><float name="alphaU" value=".2"/></bsdf></bsdf>
  <bsdf type="roughcoating" id="c"><float name="thickness" value="2"/><ref id="b"/></bsdf>
  <bsdf type="roughglass" id="d"/><bsdf type="difftrans" id="e"/><bsdf type="roughdiffuse" id="f"><float name="alpha" value=".3"/></bsdf>
  <shape type="obj"><string name="filename" value="mesh.obj"/><ref id="c"/><bsdf type="microfacet"/></shape>
  <shape type="cylinder"><transform name="toWorld"><lookAt origin="0,0,0" target="1,1,1" up="0,1,0"/></transform><ref id="d"/>
    <luminaire type="area"><blackbody name="intensity" temperature="3000K"/></luminaire></shape>
  <shape type="hair"><string name="filename" value="fibres.txt"/><ref id="f"/></shape> <shape type="sphere"><ref id="e"/></shape>
  <medium type="homogeneous" id="m"><rgb name="sigmaA" value="1"/><rgb name="sigmaS" value="2"/></medium>
  <luminaire type="sky"/><luminaire type="collimated"/></scene>
"""


def mitsuba_scenes():
    return [(name, text.encode()) for name, text in
            (("mitsuba", MITSUBA), ("mitsuba 0.5", MITSUBA_OLD), ("mitsuba surfaces", SURFACES), ("mitsuba lights", LIGHTS),
             ("mitsuba 0.4", OLDEST))]


MITSUBA_FRAGMENT = b'<scene version="3.0.0"><bsdf type="diffuse" id="white"/><shape type="sphere"><ref id="white"/></shape></scene>'
MITSUBA_INCLUDING = b'<scene version="3.0.0"><include filename="input.xml"/><sensor type="perspective"/></scene>'
SERIALIZED_NAMING = (b'<scene version="3.0.0"><shape type="serialized"><string name="filename" value="input.serialized"/>'
                     b'<integer name="shape_index" value="1"/></shape><sensor type="perspective"/></scene>')

# ---- pbrt -----------------------------------------------------------------------------------------------------------------

PBRT = """LookAt 0 0 -5 0 0 0 0 1 0
Camera "perspective" "float fov" [ 40 ] "float shutteropen" 0
Sampler "halton" "integer pixelsamples" 1
Integrator "volpath" "integer maxdepth" 3
Film "rgb" "integer xresolution" 4 "integer yresolution" [ 4 ] "string filename" "out.exr"
TransformTimes 0 1
WorldBegin # a comment
LightSource "infinite" "blackbody L" 5000 "float scale" .5
Texture "checks" "spectrum" "checkerboard" "float uscale" 4 "rgb tex1" [ .1 .2 .3 ] "spectrum tex2" [ 400 .1 700 .9 ]
MakeNamedMaterial "matt" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "matt" "matt" ] "float amount" .25
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ] "float scale" 0.1
AttributeBegin
  ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
  Rotate 30 0 1 0 Scale 1 2 -1 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 1 1 1 ]
  AreaLightSource "diffuse" "spectrum L" "stdillum-A" "bool twosided" true
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] "integer indices" [ 0 1 2 1 3 2 ] "normal N" [ 0 0 1 0 0 1 0 0 1 0 0 1 ]
AttributeEnd
Attribute "shape" "float radius" 2
ObjectBegin "thing" NamedMaterial "both" MediumInterface "fog" "" Shape "sphere" Shape "disk" "float phimax" 90 ObjectEnd
CoordinateSystem "here" CoordSysTransform "camera" ObjectInstance "thing" ReverseOrientation
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" .1
Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 1 ] "float width0" .1 "float width1" .2
Shape "loopsubdiv" "integer levels" 1 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 2 1 0 1 3 1 2 3 0 3 2 ]
"""

PBRT_V3 = """Film "image" "integer xresolution" 2 "integer yresolution" 2 Camera "orthographic" WorldBegin
LightSource "spot" "rgb I" [ 1 1 1 ] "point from" [ 0 1 0 ] "rgb scale" [ 2 2 2 ] LightSource "distant" "color L" [ 1 0 1 ]
Material "uber" "rgb Kd" [ .1 .2 .3 ] "float opacity" .5 Shape "cylinder" Material "glass" "float index" 1.3 Shape "cone"
Material "substrate" "float uroughness" .2 Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [ 0 1 2 3 ]
Material "translucent" Shape "hyperboloid" "point p1" [ 1 0 0 ] "point p2" [ .5 1 1 ] Material "disney" Shape "paraboloid" WorldEnd
"""

PBRT_PARTS = """Option "string rendercoordsys" "world" ColorSpace "rec2020" Scale -1 1 1 Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1 ]
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ] "float lensradius" .1 "float focaldistance" 3
PixelFilter "mitchell" "float xradius" 2 "float B" .3 Accelerator "bvh" Integrator "bdpt"
Film "gbuffer" "float cropwindow" [ 0 .5 0 .5 ] "float iso" 200 "string sensor" "cie1931" WorldBegin
Texture "picture" "spectrum" "imagemap" "string filename" "picture.png" "string wrap" "clamp" "string encoding" "linear" "bool invert" true
Texture "planar" "float" "fbm" "string mapping" "planar" "vector3 v1" [ 1 0 0 ] "vector3 v2" [ 0 1 0 ] "integer octaves" 3
Texture "scaled" "spectrum" "scale" "texture tex" "picture" "float scale" .5
Texture "mixed" "spectrum" "mix" "texture tex1" "scaled" "rgb tex2" [ 0 1 0 ] "texture amount" "planar"
Texture "four" "float" "bilerp" "float v00" 0 "float v11" 1 Texture "stone" "spectrum" "marble" Texture "spots" "float" "dots"
Texture "ball" "float" "windy" "string mapping" "spherical"  Texture "wound" "float" "wrinkled" "string mapping" "cylindrical"
LightSource "point" "spectrum I" [ 400 1 700 2 ] "float power" 20 LightSource "projection" "string filename" "picture.png" "float fov" 40
LightSource "goniometric" "string filename" "square.png" LightSource "infinite" "string filename" "square.png" "float illuminance" 3
LightSource "distant" "point3 from" [ 0 1 0 ] LightSource "spot" "float coneangle" 40 "float conedeltaangle" 5
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1 "float density" [ .5 1 ] "float g" .3
MakeNamedMedium "milk" "string preset" "Wholemilk" "string type" "homogeneous" MakeNamedMedium "cloud" "string type" "cloud"
MakeNamedMedium "colours" "string type" "rgbgrid" "integer nx" 2 "rgb sigma_a" [ .1 .2 .3 1 2 3 ] "rgb Le" [ 1 0 0 0 1 0 ] "float Lescale" 2
MakeNamedMedium "fire" "string type" "uniformgrid" "integer nz" 2 "float density" [ 1 1 ] "float temperature" [ 9 20 ] "float Lescale" [ 1 2 ]
  "float temperaturescale" 100 "float temperatureoffset" 5 MakeNamedMedium "file" "string type" "nanovdb" "string filename" "smoke.nvdb"
AttributeBegin Material "interface" MediumInterface "smoke" "milk" Shape "sphere" "float zmin" -.5 "float zmax" .5 AttributeEnd
Material "coateddiffuse" "texture reflectance" "mixed" "rgb albedo" [ .1 .2 .3 ] "float g" .2 "float thickness" .1
Shape "plymesh" "string filename" "mesh.ply" "texture alpha" "four" "texture displacement" "planar"
Material "coatedconductor" "float interface.roughness" .1 "string conductor.eta" "metal-Cu" "texture displacement" "planar"
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ]
Material "dielectric" "spectrum eta" "glass-BK7" "float uroughness" .1 "bool remaproughness" false Shape "cylinder" "float radius" .5
Material "thindielectric" "float eta" 1.3 Shape "disk" "float height" 1 "float innerradius" .2
Material "diffusetransmission" "rgb transmittance" [ .5 .2 .1 ] "float scale" .5 Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
Material "hair" "float eumelanin" .3 "float beta_m" .2 Shape "curve" "string basis" "bspline" "string type" "ribbon"
  "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 1 ] "normal N" [ 0 0 1 0 1 0 ] "float width" .1
Material "subsurface" "rgb mfp" [ 1 2 3 ] Shape "sphere" Material "subsurface" "string name" "Skin1" Shape "sphere"
Material "measured" "string filename" "brdf.bsdf" Shape "sphere" Material "conductor" "rgb reflectance" [ .5 .6 .7 ] Shape "sphere"
"""

PBRT_V3_PARTS = """Film "image" "float scale" 2 Sampler "stratified" "integer xsamples" 2 SurfaceIntegrator "mlt" PixelFilter "sinc" WorldBegin
MakeNamedMedium "fog" "color sigma_s" [ 1 2 3 ] "string type" "heterogeneous" "integer nx" 1 "integer ny" 1 "integer nz" 2 "float density" [ 1 2 ]
Texture "t" "color" "imagemap" "string filename" "picture.png" "float uscale" 2 "bool trilinear" true "bool gamma" true
Texture "u" "color" "checkerboard" "integer dimension" 3 "color tex1" [ 1 0 0 ] Texture "c" "float" "constant" "float value" .2
Material "matte" "texture Kd" "t" "float sigma" 20 "texture bumpmap" "c" Shape "sphere"
Material "mirror" "rgb Kr" [ .5 .5 .5 ] Shape "sphere" Material "metal" "float roughness" .01 Shape "sphere"
Material "plastic" "rgb Kd" [ .6 .1 .1 ] "rgb Ks" [ .3 .3 .3 ] Shape "sphere" Material "fourier" "string bsdffile" "x.bsdf" Shape "sphere"
Material "kdsubsurface" Shape "sphere" MakeNamedMaterial "a" "string type" "matte" MakeNamedMaterial "b" "string type" "glass" "rgb Kt" [ 1 .5 .5 ]
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [ .3 .4 .5 ] Shape "sphere"
Material "disney" "color color" [ .5 .4 .3 ] "float metallic" .3 "float spectrans" .2 "bool thin" true "float roughness" .3 Shape "sphere"
Material "hair" "color sigma_a" [ 1 2 3 ] Shape "nurbs" "integer nu" 4 TransformBegin Identity Translate 1 2 3 TransformEnd
AreaLightSource "diffuse" "blackbody L" [ 5000 2 ] "integer nsamples" 4 Shape "trianglemesh" "integer indices" [ 0 1 2 ]
  "point P" [ 0 0 0 1 0 0 0 1 0 ] "float st" [ 0 0 1 0 0 1 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ] "vector S" [ 1 0 0 1 0 0 1 0 0 ]
LightSource "infinite" "string mapname" "picture.png" "integer nsamples" 4 LightSource "projection" "string mapname" "picture.png"
WorldEnd
"""


def pbrt_scenes():
    return [(name, text.encode()) for name, text in
            (("pbrt v4", PBRT), ("pbrt v3", PBRT_V3), ("pbrt v4 parts", PBRT_PARTS), ("pbrt v3 parts", PBRT_V3_PARTS))]


PBRT_FRAGMENT = PBRT.encode().split(b"comment")[1]
PBRT_INCLUDING = b'Camera "perspective" Film "rgb" WorldBegin Include "input.pbrt" Shape "sphere"'
