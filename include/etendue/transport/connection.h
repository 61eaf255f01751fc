#pragma once
// Connections: the last segment of a path, from a vertex of one walk to a vertex of another, to a luminaire, or to the lens.
//
// With alpha what each walk brings to its vertex (SubpathVertex::throughput), a connection of y, from a luminaire, and z, from
// the camera, brings
//     alpha_y c alpha_z,   c = f_y |cos| V |cos| f_z / d^2
// (Veach 1997, section 10.1); cosines are absent in media, and V is the part that surfaces and media on the way let through.
// What strategies are weighted by is told along with it: the densities with which either walk would have gone on to the other's
// vertex, and the chance to get there.

#include <optional>

#include "etendue/transport/subpath.h"

namespace etendue {

struct Connection {
  Spectrum light;                ///< alpha_y c alpha_z
  Vector3 direction;             ///< unit, from z to y
  float pdf_at_z = 0;            ///< [1/sr] with which a walk is scattered there towards y
  float pdf_at_y = 0;            ///< [1/sr], the other way
  float mean_transmittance = 1;  ///< of getting along the segment (see subpath.h)
};

/// Between two vertices that can be connected (SubpathVertex::connectable), y of a walk from a luminaire and z of one from the
/// camera. Empty: nothing comes through. `wavelengths` are those of z's walk.
std::optional<Connection> connect(const Scene&, const SubpathVertex& y, const SubpathVertex& z, const Wavelengths&,
                                  NumberStream&, Arena&);

struct LuminaireConnection {
  Spectrum light;              ///< what the sampled point sends through z, over its density
  SubpathVertex luminaire;     ///< that point
  Vector3 direction;           ///< unit, from z to it
  bool delta = false;          ///< no walk can meet it
  float pdf_at_z = 0;          ///< [1/sr] with which a walk is scattered there towards it
  float pdf_at_luminaire = 0;  ///< [1/sr] with which light leaves towards z; 1 at infinity
  float mean_transmittance = 1;
};

/// Of a vertex of a walk from the camera with a point of a luminaire, sampled as seen from there.
std::optional<LuminaireConnection> connect_to_luminaire(const Scene&, const LightSampler&, const SubpathVertex& z,
                                                        const Wavelengths&, NumberStream&, Arena&);

struct LensConnection {
  Spectrum light;  ///< what the walk brings to the film there, as a Splat counts it
  LensSample lens;
  SubpathVertex camera;   ///< the lens point
  float pdf_at_lens = 0;  ///< with which a camera ray would have gone to y (camera_direction_density)
  float mean_transmittance = 1;
};

/// Between a vertex of a light subpath, or its first point on a luminaire, and the lens. `wavelengths` are those of the
/// subpath.
std::optional<LensConnection> connect_to_lens(const RenderContext&, const SubpathVertex& y, const Wavelengths&, NumberStream&,
                                              Arena&);

}  // namespace etendue
