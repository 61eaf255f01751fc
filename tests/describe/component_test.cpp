// Descriptions, the registry, and setting members by name.

#include <gtest/gtest.h>

#include "etendue/describe/description.h"

namespace etendue {
namespace {

class Gadget : public Component {
 public:
  using Interface = Gadget;
  using Parent = Component;
  static void describe(Description<Gadget>& d) {
    d.summary("A thing for tests.").member<&Gadget::weight>("weight", "1", "how heavy", range(0, 10));
  }
  float weight = 1;
};
static const Register<Gadget> registered_gadget;

enum class Mood { calm, wild };

class Widget final : public Gadget {
 public:
  static void describe(Description<Widget>& d) {
    d.summary("Has a member of every kind.")
        .member<&Widget::flag>("flag", "", "a flag")
        .member<&Widget::count>("count", "1", "a count", range(-5, 5))
        .member<&Widget::width>("width", "m", "a length", more_than(0))
        .member<&Widget::angle>("angle", "deg", "an angle")
        .member<&Widget::label>("label", "", "a text")
        .member<&Widget::file>("file", "", "a file")
        .member<&Widget::mood>("mood", "", "a choice", choices("calm", "wild"))
        .member<&Widget::place>("place", "m", "a point")
        .member<&Widget::color>("color", "1", "a colour", range(0, 1))
        .member<&Widget::transform>("transform", "", "a transform")
        .member<&Widget::other>("other", "", "another gadget")
        .member<&Widget::others>("others", "", "more gadgets")
        .member<&Widget::numbers>("numbers", "1", "a list of numbers")
        .member<&Widget::points>("points", "m", "a list of points");
  }
  void prepare() override { order->push_back(label); }

  bool flag = false;
  int count = 2;
  float width = 0.5f, angle = 90;
  std::string label = "none";
  FilePath file;
  Mood mood = Mood::calm;
  Point3 place{1, 2, 3};
  Color color = flat_spectrum(0.25f);
  AnimatedTransform transform;
  Ref<Gadget> other;
  std::vector<Ref<Gadget>> others;
  std::vector<float> numbers{1, 2};
  std::vector<Point3> points;
  static inline std::vector<std::string>* order = new std::vector<std::string>;
};
static const Register<Widget> registered_widget;

std::string error_of(Component& c, std::string_view member, const Value& v) {
  try {
    set(c, member, v);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

Value number(double x, Dimension d = Dimension::none) { return Value(Number{x, d}); }

TEST(Registry, KnowsClassesAndTheirMembers) {
  const ClassInfo* widget = Registry::instance().find("Widget");
  ASSERT_NE(widget, nullptr);
  EXPECT_EQ(widget->parent->name, "Gadget");
  EXPECT_FALSE(widget->abstract());
  EXPECT_EQ(widget->members.front().name, "weight");  // inherited first
  EXPECT_EQ(widget->members.front().owner->name, "Gadget");
  EXPECT_EQ(widget->find("width")->default_value.as<Number>()->value, 0.5);
  EXPECT_EQ(widget->find("other")->component_class, "Gadget");
  EXPECT_TRUE(widget->find("others")->list);
  const auto subclasses = Registry::instance().subclasses(*widget->parent);
  EXPECT_NE(std::find(subclasses.begin(), subclasses.end(), widget), subclasses.end());
  const Ref<Component> made = Registry::instance().create("Widget");
  EXPECT_EQ(&made->class_info(), widget);
}

/// A widget that weighs nothing.
class Balloon final : public Gadget {
 public:
  static void describe(Description<Balloon>& d) { d.summary("floats").without("weight", "it floats"); }
};
static const Register<Balloon> registered_balloon;

TEST(Registry, ClassesAreWithoutMembersThatMeanNothingToThem) {
  const ClassInfo* balloon = Registry::instance().find("Balloon");
  ASSERT_NE(balloon, nullptr);
  EXPECT_EQ(balloon->find("weight"), nullptr);
  EXPECT_NE(balloon->parent->find("weight"), nullptr);
  const Ref<Component> made = Registry::instance().create("Balloon");
  EXPECT_EQ(error_of(*made, "weight", number(1)), "Balloon has no member 'weight': it floats");
}

TEST(Registry, SuggestsNames) {
  try {
    Registry::instance().create("Wigdet");
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "there is no class 'Wigdet' (did you mean 'Widget'?)");
  }
}

TEST(Set, ConvertsUnits) {
  Widget w;
  set(w, "width", number(0.1, Dimension::length));
  EXPECT_FLOAT_EQ(w.width, 0.1f);
  set(w, "width", number(3));
  EXPECT_FLOAT_EQ(w.width, 3);
  set(w, "angle", number(double(pi), Dimension::angle));
  EXPECT_FLOAT_EQ(w.angle, 180);
  EXPECT_EQ(error_of(w, "width", number(1, Dimension::angle)), "Widget.width expects a length [m], not an angle");
  EXPECT_EQ(error_of(w, "weight", number(1, Dimension::length)), "Widget.weight expects a plain number, not a length");
}

TEST(Set, ChecksTypesRangesAndChoices) {
  Widget w;
  EXPECT_EQ(error_of(w, "weight", number(11)), "Widget.weight must be from 0 to 10, not 11");
  EXPECT_EQ(error_of(w, "width", number(0)), "Widget.width must be more than 0 m, not 0 m");
  EXPECT_EQ(error_of(w, "count", number(1.5)), "Widget.count expects a whole number, not 1.5");
  EXPECT_EQ(error_of(w, "weight", number(std::numeric_limits<double>::quiet_NaN())), "Widget.weight must be a finite number");
  EXPECT_EQ(error_of(w, "flag", number(1)), "Widget.flag expects true or false, not a number");
  EXPECT_EQ(error_of(w, "mood", Value(std::string("wyld"))),
            "Widget.mood has no choice 'wyld' (did you mean 'wild'?); known are calm, wild");
  EXPECT_EQ(error_of(w, "widht", number(1)), "Widget has no member 'widht' (did you mean 'width'?)");
  EXPECT_EQ(error_of(w, "place", Value(Numbers{{1, 2}, 1, {}})),
            "Widget.place expects 3 numbers in brackets, not a list of 2 numbers");
  EXPECT_EQ(error_of(w, "points", Value(Numbers{{1, 2, 3, 4}, 1, {}})),
            "Widget.points expects a list of rows of 3 numbers; 4 numbers are not a multiple of 3");
  Transform flat = Transform::scale({1, 0, 1});
  EXPECT_EQ(error_of(w, "transform", Value(flat)), "Widget.transform is a singular transform: it has no inverse");
  EXPECT_EQ(w.weight, 1);  // the refused settings changed nothing
}

TEST(Set, AcceptsFlatAndNestedRows) {
  Widget w;
  set(w, "points", Value(Numbers{{1, 2, 3, 4, 5, 6}, 1, Dimension::length}));
  ASSERT_EQ(w.points.size(), 2u);
  EXPECT_EQ(w.points[1], (Point3{4, 5, 6}));
  set(w, "points", Value(Numbers{{1, 2, 3}, 3, Dimension::none}));
  EXPECT_EQ(w.points.size(), 1u);
}

TEST(GetAndCopy, GiveBackWhatWasSet) {
  const auto w = make<Widget>();
  w->others = {make<Widget>(), make<Widget>()};
  w->other = w->others[0];
  w->angle = 12.3456789f;
  w->numbers = {0.1f, 2e-20f};
  const Ref<Component> twin = copy(*w);
  EXPECT_TRUE(equal(Value(Ref<Component>(w)), Value(twin)));
  auto* t = dynamic_cast<Widget*>(twin.get());
  EXPECT_EQ(t->other, t->others[0]);  // shared in the copy as well
  EXPECT_NE(t->other.get(), w->other.get());
  EXPECT_EQ(t->angle, w->angle);
  t->others[1]->weight = 3;
  EXPECT_FALSE(equal(Value(Ref<Component>(w)), Value(twin)));
}

TEST(Prepare, ChildrenComeFirstAndOnce) {
  const auto root = make<Widget>(), left = make<Widget>(), shared = make<Widget>();
  root->label = "root";
  left->label = "left";
  shared->label = "shared";
  left->other = shared;
  root->others = {left, shared};
  Widget::order->clear();
  prepare_tree(*root);
  EXPECT_EQ(*Widget::order, (std::vector<std::string>{"shared", "left", "root"}));
}

TEST(Reference, CountsOwners) {
  const auto w = make<Widget>();
  Ref<Gadget> g = w;
  EXPECT_EQ(g.get(), w.get());
  EXPECT_EQ(ref_cast<Widget>(g).get(), w.get());
  EXPECT_FALSE(ref_cast<Widget>(Ref<Gadget>(make<Gadget>())));
}

}  // namespace
}  // namespace etendue
