// Names of members' choices in pbrt, Mitsuba, Blender and others, with their equivalents here.
// tests/language/language_words_test.cpp checks that every name on the right exists.

#include "words.h"

namespace etendue {

namespace {

constexpr const char *mitsuba = "Mitsuba", *pbrt = "pbrt", *blender = "Blender", *many = "";

constexpr ForeignWord of_members[] = {
    // sides
    {"sides", "two", many, "'both'"},
    {"sides", "twosided", many, "'both'"},
    {"sides", "double", many, "'both'"},
    {"sides", "doublesided", many, "'both'"},
    {"sides", "all", many, "'both'"},
    {"sides", "single", many, "'front'"},
    {"sides", "one", many, "'front'"},
    {"sides", "onesided", many, "'front'"},
    {"sides", "outside", many, "'front'"},
    {"sides", "inside", many, "'back'"},
    // facets
    {"", "trowbridgereitz", pbrt, "'ggx'"},
    {"", "gtr", many, "'ggx'"},
    {"", "gtr2", many, "'ggx'"},
    {"", "multiggx", blender, "'ggx', with all light that goes from facet to facet"},
    {"", "multiscatterggx", blender, "'ggx', with all light that goes from facet to facet"},
    {"", "gaussian", many, "'beckmann'"},
    // textures
    {"", "closest", blender, "'nearest'"},
    {"", "point", pbrt, "'nearest'"},
    {"", "none", many, "'nearest'"},
    {"", "linear", many, "'bilinear'"},
    {"", "trilinear", pbrt, "'bilinear'; 'map_filter' of the 'Renderer' averages over a footprint"},
    {"", "ewa", pbrt, "'bilinear'; 'map_filter' of the 'Renderer' averages over a footprint"},
    {"", "cubic", blender, "'bilinear'"},
    {"", "smart", blender, "'bilinear'"},
    {"", "tile", many, "'repeat'"},
    {"", "periodic", many, "'repeat'"},
    {"", "mirrored", many, "'mirror'"},
    {"", "extend", blender, "'clamp'"},
    {"", "edge", many, "'clamp'"},
    {"", "clip", blender, "'black'"},
    {"", "zero", many, "'black'"},
    {"", "border", many, "'black'"},
    {"", "constant", blender, "'step'"},
    {"", "ease", blender, "'smooth'"},
    {"", "smoothstep", many, "'smooth'"},
    {"", "f1", blender, "'nearest'"},
    {"", "f2", blender, "'second_nearest'"},
    {"", "distancetoedge", blender, "'difference', which is 0 on edges too"},
    {"", "local", many, "'object'"},
    {"", "generated", blender, "'object'"},
    {"", "global", many, "'world'"},
    {"space", "texture", many, "'uv'"},
    // curves and surfaces
    {"", "flat", pbrt, "'ribbon'"},
    {"", "strip", blender, "'ribbon'"},
    {"form", "cylinder", pbrt, "'tube'"},
    {"form", "round", many, "'tube'"},
    {"form", "thick", blender, "'tube'"},
    {"", "catmark", many, "'catmull_clark'"},
    {"scheme", "simple", blender, "'bilinear'"},
    {"", "edgeonly", many, "'edges'"},
    {"", "edgeandcorner", many, "'edges_and_corners'"},
    {"", "cornersonly", many, "'corners'"},
    {"", "cornersplus1", many, "'corners_and_junctions'"},
    {"", "cornersplus2", many, "'corners_and_darts'"},
    // cameras and pictures
    {"", "x", mitsuba, "'width'"},
    {"", "y", mitsuba, "'height'"},
    {"", "horizontal", many, "'width'"},
    {"", "vertical", many, "'height'"},
    {"", "auto", many, "'automatic'"},
    {"", "manual", many, "'fixed'"},
    {"", "float16", many, "'half'"},
    {"", "float32", many, "'float'"},
    {"precision", "single", many, "'float'"},
    {"precision", "full", blender, "'float'"},
    // renderers
    {"", "emitter", mitsuba, "'light'"},
    {"", "lights", many, "'light'"},
    {"", "bsdf", many, "'shader'"},
    {"", "brdf", many, "'shader'"},
    {"", "mis", many, "'both'"},
    {"", "shnormal", mitsuba, "'shading_normal'"},
    {"", "ns", pbrt, "'shading_normal'"},
    {"", "geonormal", mitsuba, "'normal'"},
    {"", "z", blender, "'depth'"},
    {"", "distance", many, "'depth'"},
    {"", "basecolor", many, "'albedo'"},
    {"", "diffusecolor", blender, "'albedo'"},
    {"", "primindex", mitsuba, "'primitive'"},
    {"", "shapeindex", mitsuba, "'object'"},
    {"", "objectindex", blender, "'object'"},
    // light inside bodies
    {"", "burley", many, "'diffusion'"},
    {"", "christensenburley", blender, "'diffusion'"},
    {"", "dipole", many, "'diffusion'"},
    {"", "bssrdf", many, "'diffusion'"},
    {"", "volpath", mitsuba, "'random_walk'"},
    {"", "reflectance", pbrt, "'color'"},
    {"", "directcoloring", blender, "'color'"},
    {"", "eumelanin", pbrt, "'melanin'"},
    {"", "sigmaa", many, "'absorption'"},
};

}  // namespace

std::span<const ForeignWord> foreign_choices() { return of_members; }

}  // namespace etendue
