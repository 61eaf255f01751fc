// Edits of a Render, which are made completely or not at all.

#include "describe/guard.h"
#include "render_members.h"

namespace etendue {
namespace {

/// Readers of a render get its components as const; only edits may change them, here.
Component& editable(const Edit& edit) { return const_cast<Component&>(*edit.component); }

/// Sets all members or none; `put_back` restores the old values.
class Changes {
 public:
  explicit Changes(std::span<const Edit> edits) {
    for (const Edit& edit : edits) {
      before_.push_back({edit.component, edit.member, get(*edit.component, edit.member)});
      try {
        set(editable(edit), edit.member, edit.value);
      } catch (...) {
        before_.pop_back();
        put_back();
        throw;
      }
    }
  }
  void put_back() {
    while (!before_.empty()) {
      const Edit& edit = before_.back();
      set(editable(edit), edit.member, edit.value);
      before_.pop_back();
    }
  }

 private:
  std::vector<Edit> before_;
};

}  // namespace

void Render::edit(const Component& component, const std::string& member, const Value& value) {
  const Edit one{Ref<const Component>(&component), member, value};
  edit(std::span(&one, 1));
}

void Render::edit(std::span<const Edit> edits) {
  const Team* const team = members_->settings.team;
  if (team && team->leads() && !team->follows_edits()) throw Error("a render that several processes compute cannot be edited");
  const std::lock_guard one_at_a_time(members_->editing);
  if (!members_->holders) members_->holders = std::make_unique<Holders>(*members_->job);
  Consequences consequences;
  for (const Edit& edit : edits) {
    if (!edit.component || !members_->holders->knows(*edit.component))
      throw Error("what is to be edited is no part of the job that is rendered");
    const Member* member = edit.component->class_info().find(edit.member);
    if (!member) get(*edit.component, edit.member);  // throws Error with the list of members
    consequences.note(*members_->holders, editable(edit), *member, edit.value);
  }

  std::optional<BetweenSteps> alone;
  if (consequences.effect() != Effect::retone) alone.emplace(*members_, consequences.effect() >= Effect::rerender);
  const std::unique_lock unseen(members_->look);
  Changes changes(edits);
  if (alone) {
    members_->park_process();
    members_->assembled = false;
  }
  try {
    consequences.prepare(*members_->job, *members_->holders);
    members_->follow(consequences);
  } catch (...) {
    const std::exception_ptr reason = std::current_exception();
    try {
      changes.put_back();
      consequences.prepare(*members_->job, *members_->holders);
    } catch (const std::exception& e) {
      members_->broken = std::string("an edit that failed could not be undone: ") + e.what();
    }
    std::rethrow_exception(reason);
  }
  if (consequences.structure()) members_->holders.reset();
}

/// Continues or starts over after an edit. Throws before any collected samples are lost.
void Render::Members::follow(const Consequences& consequences) {
  if (consequences.effect() == Effect::retone) return;
  wanted();
  identity.reset();
  names.reset();
  const std::uint32_t size = samples_per_step();
  if (consequences.effect() == Effect::none) {
    // More samples continue from the existing ones; fewer give another picture.
    const bool too_many = !done.empty() && done.back().end > std::uint32_t(job->renderer->samples);
    if (too_many || size != step_size) empty();
  } else {
    std::unique_ptr<RenderProcess> next = fresh_process();
    const bool light_kept = film->follow(*job->image, job->renderer->estimator()),
               surfaces_kept = surfaces->follow(*job->image);
    if (!light_kept || !surfaces_kept || !consequences.concern_only(*job->image)) {
      empty();
      process = std::move(next);
    }
  }
  step_size = size;
}

}  // namespace etendue
