#pragma once
// OslClass: a class of the description that is a shader in the language, and the objects of such classes.

#include <memory>
#include <string>
#include <vector>

#include "etendue/describe/declared_class.h"
#include "osl/closures/closure_models.h"
#include "osl/language/tree.h"
#include "osl/running/shader_group.h"

namespace etendue::osl {

/// What a class is made from, in ClassInfo::declared.
struct OslClass {
  enum class Role : unsigned char { surface, emission, volume, map };
  /// A member of the class that is a parameter of the shader. Their names differ only where the description has the name for
  /// something else.
  struct Parameter {
    const Symbol* symbol;
    std::string member;
  };

  std::shared_ptr<const Shader> shader;
  std::shared_ptr<const Shader> own;  ///< of which the name, the metadata and the defaults are; `shader` unless that is shared
  std::string file;
  Role role = Role::surface;
  ClosureUses uses;
  std::vector<Parameter> parameters;
  /// Of a map: the parameters that can be its value, or others that can only be connected; of a displacement "displacement".
  std::vector<std::string> outputs;
  /// A surface that lets no light through if all these members have these values in all their components, whatever closures
  /// its text names; none: the text alone says it. From the shader's metadatum etendue_opaque, "transmission=0 opacity=1".
  std::vector<std::pair<std::string, float>> opaque;
};

/// The classes of a compiled shader: one for each thing that it can be. Throws Error with the place. `own`: not null where
/// several classes share the shader: a shader of the same parameters, whose name, metadata and defaults are those of the class.
std::vector<std::unique_ptr<ClassInfo>> make_classes(std::shared_ptr<const Shader>, const std::string& file,
                                                     std::shared_ptr<const Shader> own = nullptr);

/// Makes an object of a class. One function for each role, in the file of that role.
Ref<Component> make_surface(const ClassInfo&);
Ref<Component> make_emission(const ClassInfo&);
Ref<Component> make_volume(const ClassInfo&);
Ref<Component> make_map(const ClassInfo&);

/// The value of a parameter as it lies in memory, from that of its member.
Constant constant_of(const Type&, const Member&, const etendue::Value&);
Constant constant_number(const Type&, float);
Constant constant_color(const Type&, const SpectralFunction&);

/// Declares the classes of a file, or those that changed since the last call. Throws Error with the faults of its text.
void declare_file(const std::string& file);
/// The shader NAME.osl of the first of the folders that has it, else that of a class with this name. Throws Error at `at` if
/// there is none, or with the faults of its text.
std::shared_ptr<const Shader> declared_shader(const std::string& name, const std::vector<std::string>& folders, Location at);

}  // namespace etendue::osl
