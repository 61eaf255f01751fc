#pragma once
// A network of shaders as its user states it: layers with parameter values, and connections between them. The text form is that
// of the language's specification ("Describing shader groups"):
//
//   param float scale 3.5 ;
//   shader texturemap tex1 ;
//   shader wood wood1 ;
//   connect tex1.Cout wood1.rings ;

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"
#include "tree.h"

namespace etendue::osl {

/// A parameter's value, before it is known what the shader declares.
struct ParameterText {
  std::string name;
  std::string type;                ///< "float", "color[3]"; empty: as the words look (infer_type)
  std::vector<std::string> words;  ///< numbers or texts, without quotation marks
  bool interpolated = false;       ///< may be replaced by data of the geometry (lockgeom=0)
  Location at;
  std::optional<Constant> value;  ///< instead of type and words, for a value that is no text
};

struct LayerText {
  std::string shader, name;
  std::vector<ParameterText> parameters;
  Location at;
};

/// `from` and `to` are parameters with optional elements, components and fields, as in "out", "C[1]", "s.x".
struct ConnectionText {
  std::string from_layer, from, to_layer, to;
  Location at;
};

struct GroupDescription {
  std::string name;
  std::vector<LayerText> layers;  ///< each only after those that it is connected to
  std::vector<ConnectionText> connections;
  std::vector<std::string> entries;  ///< layers that are run in this order; empty: the last, with all that it needs
};

/// Reads the text form. Statements end with ';' or, in the text of a command line, with ','. Throws Error with the place.
GroupDescription parse_group(std::string_view text, const std::string& file);

/// The type of a value that is given without one, as by the harness: one whole number is an int, another number a float, three
/// numbers with commas a color (any triple), sixteen a matrix, all else a string. Separates the words of such a value.
std::string infer_type(std::vector<std::string>& words);

}  // namespace etendue::osl
