#include "osl_part.h"

#include <fmt/format.h>

#include "osl/running/places.h"

namespace etendue::osl {

void OslPart::build_group(const Component& self, std::vector<std::string> outputs) {
  GroupDescription description;
  description.name = info_.name;
  LayerText layer;
  layer.shader = of_.shader->name;
  layer.name = "surface";
  for (const OslClass::Parameter& parameter : of_.parameters) {
    const auto given = declared_values.find(parameter.member);
    if (given == declared_values.end()) continue;
    const Member& m = *info_.find(parameter.member);
    ParameterText text;
    text.name = parameter.symbol->name;
    try {
      text.value = constant_of(parameter.symbol->type, m, given->second);
    } catch (const Error& e) {
      self.fail(parameter.member, e.what());
    }
    text.type = text.value->type.name();
    layer.parameters.push_back(std::move(text));
  }
  description.layers.push_back(std::move(layer));
  GroupOptions options;
  options.load = [this](const std::string&, Location) { return of_.shader; };
  options.outputs_only = !outputs.empty();
  options.outputs = outputs;
  std::vector<GroupProblem> problems;
  group_ = ShaderGroup::build(description, options, problems);
  std::string faults;
  for (const GroupProblem& problem : problems) {
    const std::string text = problem.at.known() ? place_text(problem.at) + ": " + problem.text : problem.text;
    if (problem.warning)
      warn(info_.name + ": " + text, problem.at);
    else
      faults += (faults.empty() ? "" : "\n") + text;
  }
  if (!group_) self.fail("", faults.empty() ? "the shader cannot be run" : faults);
  if (outputs.empty()) return;
  const auto found = group_->find_output(outputs.front());
  if (!found) self.fail("", fmt::format("the shader has no output '{}'", outputs.front()));
  output_ = *found;
}

bool OslPart::all_set(const std::vector<std::pair<std::string, float>>& settings) const {
  for (const auto& [name, wanted] : settings) {
    const Member* m = info_.find(name);
    if (!m || (m->kind != Kind::number && m->kind != Kind::color)) return false;
    const auto given = declared_values.find(name);
    const etendue::Value& value = given == declared_values.end() ? m->default_value : given->second;
    const Constant c = constant_of(m->kind == Kind::color ? Type(Base::color) : Type(Base::float_), *m, value);
    for (size_t i = 0; i < c.bytes.size() / sizeof(float); ++i)
      if (c.at<float>(i) != wanted) return false;
  }
  return !settings.empty();
}

OslPart::Run::Run(const OslPart& part, const SurfacePoint& p, const Wavelengths* w)
    : part_(part),
      globals_(globals_of(p, from_behind_)),
      before_(globals_),
      execution_((part.group_ ? *part.group_ : throw Error(part.info_.name + " is used before it is prepared")).execution()) {
  thread_local PointMemory memory;
  memory.reset();
  RenderServices services(p, w, memory, part.info_.name);
  execution_.run(globals_, services);
}

}  // namespace etendue::osl
