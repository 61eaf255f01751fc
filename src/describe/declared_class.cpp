#include "etendue/describe/declared_class.h"

#include "etendue/describe/description.h"

namespace etendue {

DeclaredMembers::~DeclaredMembers() = default;

namespace {

Value get_declared(const Component& c, const Member& m) {
  const auto& values = dynamic_cast<const DeclaredMembers&>(c).declared_values;
  const auto found = values.find(m.name);
  return found == values.end() ? m.default_value : found->second;
}

/// Converts a value to the C++ type that a compiled class would have, and back: that checks it and brings it into its plain
/// form.
template <class T>
void store_as(Component& c, const Member& m, const Value& v) {
  T converted{};
  detail::Convert<T>::read(v, m, converted);
  dynamic_cast<DeclaredMembers&>(c).declared_values.insert_or_assign(m.name, detail::Convert<T>::write(converted, m));
}

template <class T>
void store_by(Member& m) {
  m.store = m.list ? store_as<std::vector<T>> : store_as<T>;
}

}  // namespace

void keep_as_value(Member& m) {
  m.get = get_declared;
  m.in_double = m.kind == Kind::number || m.kind == Kind::point3;
  if (m.kind == Kind::boolean && m.list) throw Error("member '" + m.name + "' is a list of booleans, which the language lacks");
  switch (m.kind) {
    case Kind::boolean: m.store = store_as<bool>; break;
    case Kind::integer: store_by<std::int64_t>(m); break;
    case Kind::number: store_by<double>(m); break;
    case Kind::string:
    case Kind::choice: store_by<std::string>(m); break;
    case Kind::file: store_by<FilePath>(m); break;
    case Kind::vector2: store_by<Vector2>(m); break;
    case Kind::vector3: store_by<Vector3>(m); break;
    case Kind::point3: store_by<DoublePoint3>(m); break;
    case Kind::normal3: store_by<Normal3>(m); break;
    case Kind::color: store_by<Color>(m); break;
    case Kind::transform: store_by<AnimatedTransform>(m); break;
    case Kind::component: store_by<Ref<Component>>(m); break;
  }
}

}  // namespace etendue
