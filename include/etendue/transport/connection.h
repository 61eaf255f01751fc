#pragma once
// Connections: the last segment of a path, from a vertex of a subpath to a vertex of another one, to a luminaire, or to the
// lens.
//
// With alpha the throughputs of the subpaths (SubpathVertex::throughput), the connection of y, on a light subpath, with z, on a
// camera subpath, has the contribution
//     alpha_y c alpha_z,   c = f_y |cos| V |cos| f_z / d^2     (Veach 1997, section 10.1).
// In media the phase function replaces f |cos|, and V is the transmittance of the surfaces and media between y and z. Returned
// as well are the pdfs with which either subpath would have sampled the direction to the other vertex, and the mean
// transmittance of the segment: the weights of the strategies need them.

#include <optional>

#include "etendue/transport/subpath.h"

namespace etendue {

struct Connection {
  Spectrum light;                ///< alpha_y c alpha_z
  Vector3 direction;             ///< unit, from z to y
  float pdf_at_z = 0;            ///< [1/sr] with which the camera subpath samples the direction from z to y
  float pdf_at_y = 0;            ///< [1/sr] with which the light subpath samples the direction from y to z
  float mean_transmittance = 1;  ///< of the segment (see subpath.h)
};

/// Connects two vertices for which SubpathVertex::connectable is true: y of a light subpath and z of a camera subpath. Empty:
/// the contribution is 0. The wavelengths are those of the camera subpath.
std::optional<Connection> connect(const Scene&, const SubpathVertex& y, const SubpathVertex& z, const Wavelengths&,
                                  NumberStream&, Arena&);

struct LuminaireConnection {
  Spectrum light;              ///< contribution of the sampled point through z, over its pdf: alpha_z f |cos| L_e V / (P p)
  SubpathVertex luminaire;     ///< the sampled point
  Vector3 direction;           ///< unit, from z to it
  bool delta = false;          ///< a delta light: no walk can hit it
  float pdf_at_z = 0;          ///< [1/sr] with which a walk samples the direction from z to it
  float pdf_at_luminaire = 0;  ///< [1/sr] of emission towards z; 1 at infinity
  float mean_transmittance = 1;
};

/// Next event estimation: connects a vertex of a camera subpath to a point of a luminaire that is sampled as seen from the
/// vertex.
std::optional<LuminaireConnection> connect_to_luminaire(const Scene&, const LightSampler&, const SubpathVertex& z,
                                                        const Wavelengths&, NumberStream&, Arena&);

struct LensConnection {
  Spectrum light;  ///< the value of a Splat
  LensSample lens;
  float mean_transmittance = 1;
};

/// Connects a vertex of a light subpath, which may be its first point on a luminaire, to the lens. The wavelengths are those of
/// the light subpath.
std::optional<LensConnection> connect_to_lens(const RenderContext&, const SubpathVertex& y, const Wavelengths&, NumberStream&,
                                              Arena&);

}  // namespace etendue
