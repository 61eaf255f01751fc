#pragma once
// Connections: the last segment of a path, from a vertex of one walk to a vertex of another, to a luminaire, or to the lens.
//
// With alpha what each walk brings to its vertex (KeptVertex::throughput), a connection of y, from a luminaire, and z, from the
// camera, brings
//     alpha_y c alpha_z,   c = f_y |cos| V |cos| f_z / d^2
// (Veach 1997, section 10.1); cosines are absent in media, and V is the part that surfaces and media on the way let through.
// What strategies are weighted by is told along with it: the densities with which either walk would have gone on to the other's
// vertex, and the chance to get there.

#include <optional>

#include "etendue/transport/kept_walk.h"

namespace etendue {

struct Connection {
  Spectrum light;          ///< alpha_y c alpha_z
  Vector3 direction;       ///< unit, from z to y
  float density_at_z = 0;  ///< [1/sr] with which a walk is scattered there towards y
  float density_at_y = 0;  ///< [1/sr], the other way
  float chance = 1;        ///< of getting along the segment (see kept_walk.h)
};

/// Between two vertices that can be connected (KeptVertex::connectable), y of a walk from a luminaire and z of one from the
/// camera. Empty: nothing comes through. `wavelengths` are those of z's walk.
std::optional<Connection> connect(const Scene&, const KeptVertex& y, const KeptVertex& z, const Wavelengths&, NumberStream&,
                                  Arena&);

struct LuminaireConnection {
  Spectrum light;                  ///< what the sampled point sends through z, over its density
  KeptVertex luminaire;            ///< that point
  Vector3 direction;               ///< unit, from z to it
  bool delta = false;              ///< no walk can meet it
  float density_at_z = 0;          ///< [1/sr] with which a walk is scattered there towards it
  float density_at_luminaire = 0;  ///< [1/sr] with which light leaves towards z; 1 at infinity
  float chance = 1;
};

/// Of a vertex of a walk from the camera with a point of a luminaire, sampled as seen from there.
std::optional<LuminaireConnection> connect_to_luminaire(const Scene&, const LightSampler&, const KeptVertex& z,
                                                        const Wavelengths&, NumberStream&, Arena&);

struct LensConnection {
  Spectrum light;  ///< what the walk brings to the film there, as a Splat counts it
  LensSample lens;
  KeptVertex camera;          ///< the lens point
  float density_at_lens = 0;  ///< with which a camera ray would have gone to y (camera_direction_density)
  float chance = 1;
};

/// Of a vertex of a walk from a luminaire with the lens. `wavelengths` are those of that walk.
std::optional<LensConnection> connect_to_lens(const RenderContext&, const KeptVertex& y, const Wavelengths&, NumberStream&,
                                              Arena&);

}  // namespace etendue
