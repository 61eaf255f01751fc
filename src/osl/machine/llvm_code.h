#pragma once
// LlvmCode: makes the code of one layer as a function in LLVM's intermediate form.

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>

#include <unordered_map>
#include <vector>

#include "osl/running/machine.h"

namespace etendue::osl {

class LlvmCode final : public Code {
 public:
  /// Begins the function `name(RunState*, memory, Services*)`.
  LlvmCode(llvm::Module&, const std::string& name, const MemoryLayout&);
  /// Ends the function.
  void finish();

  Word integer(int) override;
  Word number(float) override;
  Word address(const void*) override;
  Word arithmetic(Arithmetic, Word, Word) override;
  Word function(Function, Word) override;
  Word compare(Comparison, Word, Word) override;
  Word select(Word truth, Word yes, Word no) override;
  Word int_of_truth(Word) override;
  Word float_of_int(Word) override;
  Word int_of_float(Word) override;
  Word load(WordKind, const Spot&) override;
  void store(const Spot&, Word) override;
  void copy(const Spot& to, const Spot& from, std::size_t bytes) override;
  void clear(const Spot&, std::size_t bytes) override;
  Word flag(std::uint32_t offset) override;
  Word address_of(const Spot&) override;
  Word element(Word base, Word index, std::uint32_t step) override;
  bool own(std::uint32_t offset) const override;
  const std::byte* constant(std::uint32_t offset) const override;
  Word borrow(std::size_t bytes) override;
  void give_back(Word) override;
  Word run_state() override;
  Word services() override;
  Word tick() override;
  Word call(const void* function, WordKind result, std::span<const Word>) override;
  using Code::call;
  Word call_pure(const void* function, WordKind result, std::span<const Word>) override;
  Label label() override;
  void jump(Label) override;
  void branch(Word truth, Label yes, Label no) override;
  void begin(Label) override;

 private:
  const MemoryLayout::Area* area(std::uint32_t offset) const;
  llvm::Value* pointer(const Spot&);
  llvm::Type* type(WordKind) const;
  llvm::AllocaInst* allocate(std::size_t bytes, std::size_t alignment);
  llvm::CallInst* call_instruction(const void* function, WordKind result, std::span<const Word>);
  llvm::BasicBlock* block(Label);

  const MemoryLayout& layout_;
  std::vector<bool> own_;                                      ///< by the number of the area
  std::unordered_map<std::size_t, llvm::AllocaInst*> copies_;  ///< of areas of the frame, by their numbers
  std::vector<llvm::AllocaInst*> lent_;                        ///< memory of calls that is free again
  std::unordered_map<llvm::Value*, std::size_t> lent_sizes_;
  std::vector<llvm::BasicBlock*> labels_;
  std::size_t begun_ = 0;  ///< labels
  llvm::AllocaInst* counter_ = nullptr;
  llvm::IRBuilder<> builder_;
  llvm::Function* function_;
  llvm::Instruction* allocations_end_ = nullptr;  ///< the jump behind all allocations
};

}  // namespace etendue::osl
