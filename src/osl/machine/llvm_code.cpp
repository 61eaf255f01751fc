#include "llvm_code.h"

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "etendue/core/error.h"

namespace etendue::osl {
namespace {

llvm::Value* value(Word w) { return static_cast<llvm::Value*>(w.value); }

/// Variables that are larger stay in the frame, as does what exceeds the sum: a thread's stack is small [bytes].
constexpr std::size_t largest_copy = 4096, all_copies = 128 * 1024;

/// More instructions than this are not compiled: that would take minutes.
constexpr std::size_t most_instructions = 400'000;

}  // namespace

LlvmCode::LlvmCode(llvm::Module& module, const std::string& name, const MemoryLayout& layout)
    : layout_(layout), builder_(module.getContext()) {
  llvm::Type* address = builder_.getPtrTy();
  auto* signature = llvm::FunctionType::get(builder_.getVoidTy(), {address, address, address}, false);
  function_ = llvm::Function::Create(signature, llvm::Function::ExternalLinkage, name, module);
  function_->setUWTableKind(llvm::UWTableKind::Async);  // the library throws through the code
  function_->addParamAttr(1, llvm::Attribute::getWithAlignment(module.getContext(), llvm::Align(MemoryLayout::alignment)));
  auto* entry = llvm::BasicBlock::Create(module.getContext(), "entry", function_);
  auto* begin = llvm::BasicBlock::Create(module.getContext(), "begin", function_);
  builder_.SetInsertPoint(entry);
  allocations_end_ = builder_.CreateBr(begin);
  builder_.SetInsertPoint(begin);
  counter_ = allocate(sizeof(int), alignof(int));
  builder_.CreateStore(builder_.getInt32(0), counter_);
  labels_.push_back(nullptr);  // Label::none
  std::size_t sum = 0;
  for (const MemoryLayout::Area& a : layout.areas()) {
    const bool own = a.use == MemoryLayout::Use::own && a.size <= largest_copy && sum + a.size <= all_copies;
    own_.push_back(own);
    if (own) sum += a.size;
  }
  targets.exit = label();
  targets.leave = targets.exit;
}

void LlvmCode::finish() {
  jump(targets.exit);
  begin(targets.exit);
  builder_.CreateRetVoid();
}

// ---- constants -----------------------------------------------------------------------------------------------------------

Word LlvmCode::integer(int i) { return {builder_.getInt32(std::uint32_t(i))}; }
Word LlvmCode::number(float f) { return {llvm::ConstantFP::get(builder_.getContext(), llvm::APFloat(f))}; }
Word LlvmCode::address(const void* p) {
  if (!p) return {llvm::ConstantPointerNull::get(builder_.getPtrTy())};
  return {llvm::ConstantExpr::getIntToPtr(builder_.getInt64(std::bit_cast<std::uint64_t>(p)), builder_.getPtrTy())};
}

// ---- arithmetic ----------------------------------------------------------------------------------------------------------

Word LlvmCode::arithmetic(Arithmetic how, Word a_, Word b_) {
  llvm::Value *a = value(a_), *b = value(b_);
  const bool real = a->getType()->isFloatTy();
  switch (how) {
    case Arithmetic::add: return {real ? builder_.CreateFAdd(a, b) : builder_.CreateAdd(a, b)};
    case Arithmetic::subtract: return {real ? builder_.CreateFSub(a, b) : builder_.CreateSub(a, b)};
    case Arithmetic::multiply: return {real ? builder_.CreateFMul(a, b) : builder_.CreateMul(a, b)};
    case Arithmetic::divide: return {real ? builder_.CreateFDiv(a, b) : builder_.CreateSDiv(a, b)};
    case Arithmetic::remainder: return {builder_.CreateSRem(a, b)};
    case Arithmetic::bit_and: return {builder_.CreateAnd(a, b)};
    case Arithmetic::bit_or: return {builder_.CreateOr(a, b)};
    case Arithmetic::bit_xor: return {builder_.CreateXor(a, b)};
    case Arithmetic::shift_left: return {builder_.CreateShl(a, b)};
    case Arithmetic::shift_right: return {builder_.CreateAShr(a, b)};
  }
  return {};
}

Word LlvmCode::function(Function f, Word a_) {
  llvm::Value* a = value(a_);
  const auto intrinsic = [&](llvm::Intrinsic::ID id) { return Word{builder_.CreateUnaryIntrinsic(id, a)}; };
  switch (f) {
    case Function::negate: return {builder_.CreateFNeg(a)};
    case Function::absolute: return intrinsic(llvm::Intrinsic::fabs);
    case Function::square_root: return intrinsic(llvm::Intrinsic::sqrt);
    case Function::floor: return intrinsic(llvm::Intrinsic::floor);
    case Function::ceiling: return intrinsic(llvm::Intrinsic::ceil);
    case Function::round: return intrinsic(llvm::Intrinsic::round);
    case Function::truncate: return intrinsic(llvm::Intrinsic::trunc);
  }
  return {};
}

Word LlvmCode::compare(Comparison how, Word a_, Word b_) {
  using P = llvm::CmpInst::Predicate;
  llvm::Value *a = value(a_), *b = value(b_);
  const bool real = a->getType()->isFloatTy();
  P p = P::ICMP_EQ;
  switch (how) {
    case Comparison::equal: p = real ? P::FCMP_OEQ : P::ICMP_EQ; break;
    case Comparison::unequal: p = real ? P::FCMP_UNE : P::ICMP_NE; break;
    case Comparison::less: p = real ? P::FCMP_OLT : P::ICMP_SLT; break;
    case Comparison::less_equal: p = real ? P::FCMP_OLE : P::ICMP_SLE; break;
    case Comparison::greater: p = real ? P::FCMP_OGT : P::ICMP_SGT; break;
    case Comparison::greater_equal: p = real ? P::FCMP_OGE : P::ICMP_SGE; break;
  }
  return {real ? builder_.CreateFCmp(p, a, b) : builder_.CreateICmp(p, a, b)};
}

Word LlvmCode::select(Word truth, Word yes, Word no) { return {builder_.CreateSelect(value(truth), value(yes), value(no))}; }
Word LlvmCode::int_of_truth(Word w) { return {builder_.CreateZExt(value(w), builder_.getInt32Ty())}; }
Word LlvmCode::float_of_int(Word w) { return {builder_.CreateSIToFP(value(w), builder_.getFloatTy())}; }
Word LlvmCode::int_of_float(Word w) { return {builder_.CreateFPToSI(value(w), builder_.getInt32Ty())}; }

// ---- memory --------------------------------------------------------------------------------------------------------------

llvm::Type* LlvmCode::type(WordKind kind) const {
  llvm::LLVMContext& context = function_->getContext();
  switch (kind) {
    case WordKind::none: break;
    case WordKind::int_: return llvm::Type::getInt32Ty(context);
    case WordKind::float_: return llvm::Type::getFloatTy(context);
    case WordKind::address: return llvm::PointerType::getUnqual(context);
  }
  return llvm::Type::getVoidTy(context);
}

const MemoryLayout::Area* LlvmCode::area(std::uint32_t offset) const {
  const auto& areas = layout_.areas();
  const auto next = std::upper_bound(areas.begin(), areas.end(), offset,
                                     [](std::uint32_t o, const MemoryLayout::Area& a) { return o < a.offset; });
  if (next == areas.begin()) return nullptr;
  const auto& found = *std::prev(next);
  return offset - found.offset < found.size ? &found : nullptr;
}

llvm::AllocaInst* LlvmCode::allocate(std::size_t bytes, std::size_t alignment) {
  auto* kind = llvm::ArrayType::get(builder_.getInt8Ty(), std::max<std::size_t>(bytes, 1));
  auto* made = new llvm::AllocaInst(kind, 0, nullptr, llvm::Align(alignment), "", allocations_end_);
  return made;
}

bool LlvmCode::own(std::uint32_t offset) const {
  const MemoryLayout::Area* a = area(offset);
  return a && own_[std::size_t(a - layout_.areas().data())];
}

const std::byte* LlvmCode::constant(std::uint32_t offset) const {
  const MemoryLayout::Area* a = area(offset);
  return a && a->use == MemoryLayout::Use::constant ? layout_.image().data() + offset : nullptr;
}

llvm::Value* LlvmCode::pointer(const Spot& at) {
  llvm::Value* base = function_->getArg(1);
  std::uint32_t offset = at.offset;
  if (at.base.value) {
    base = value(at.base);
  } else if (const MemoryLayout::Area* a = area(offset)) {
    if (const auto number = std::size_t(a - layout_.areas().data()); own_[number]) {
      llvm::AllocaInst*& copy = copies_[number];
      // As aligned as in the frame, up to the alignment of the largest word.
      const std::size_t aligned = std::size_t(1) << std::countr_zero(a->offset | std::uint32_t(32));
      if (!copy) copy = allocate(a->size, std::max<std::size_t>(aligned, 4));
      base = copy;
      offset -= a->offset;
    }
  }
  return offset ? builder_.CreateConstInBoundsGEP1_64(builder_.getInt8Ty(), base, offset) : base;
}

Word LlvmCode::load(WordKind kind, const Spot& at) {
  const std::byte* const bytes = at.base.value ? nullptr : constant(at.offset);
  if (bytes) {
    if (kind == WordKind::int_) return integer(*reinterpret_cast<const int*>(bytes));
    if (kind == WordKind::float_) return number(*reinterpret_cast<const float*>(bytes));
    return address(*reinterpret_cast<const void* const*>(bytes));
  }
  const llvm::Align alignment(kind == WordKind::address ? 8 : 4);
  return {builder_.CreateAlignedLoad(type(kind), pointer(at), alignment)};
}

void LlvmCode::store(const Spot& at, Word w) {
  const llvm::Align alignment(value(w)->getType()->isPointerTy() ? 8 : 4);
  builder_.CreateAlignedStore(value(w), pointer(at), alignment);
}

void LlvmCode::copy(const Spot& to, const Spot& from, std::size_t bytes) {
  builder_.CreateMemMove(pointer(to), llvm::Align(4), pointer(from), llvm::Align(4), bytes);
}

void LlvmCode::clear(const Spot& at, std::size_t bytes) {
  builder_.CreateMemSet(pointer(at), builder_.getInt8(0), bytes, llvm::Align(4));
}

Word LlvmCode::flag(std::uint32_t offset) {
  return {builder_.CreateIsNotNull(builder_.CreateLoad(builder_.getInt8Ty(), pointer({offset, {}})))};
}

Word LlvmCode::address_of(const Spot& at) { return {pointer(at)}; }

Word LlvmCode::element(Word base, Word index, std::uint32_t step) {
  llvm::Value* bytes = builder_.CreateMul(builder_.CreateZExt(value(index), builder_.getInt64Ty()), builder_.getInt64(step));
  return {builder_.CreateInBoundsGEP(builder_.getInt8Ty(), value(base), bytes)};
}

Word LlvmCode::borrow(std::size_t bytes) {
  const auto fits = [&](llvm::AllocaInst* memory) { return lent_sizes_[memory] >= bytes && lent_sizes_[memory] <= 2 * bytes; };
  if (const auto found = std::find_if(lent_.begin(), lent_.end(), fits); found != lent_.end()) {
    llvm::AllocaInst* memory = *found;
    lent_.erase(found);
    return {memory};
  }
  llvm::AllocaInst* memory = allocate(bytes, 32);
  lent_sizes_[memory] = bytes;
  return {memory};
}

void LlvmCode::give_back(Word memory) { lent_.push_back(static_cast<llvm::AllocaInst*>(value(memory))); }

// ---- calls ---------------------------------------------------------------------------------------------------------------

Word LlvmCode::run_state() { return {function_->getArg(0)}; }
Word LlvmCode::services() { return {function_->getArg(2)}; }

Word LlvmCode::tick() {
  llvm::Value* count = builder_.CreateAdd(builder_.CreateLoad(builder_.getInt32Ty(), counter_), builder_.getInt32(1));
  builder_.CreateStore(count, counter_);
  return {builder_.CreateICmpEQ(builder_.CreateAnd(count, builder_.getInt32(255)), builder_.getInt32(0))};
}

llvm::CallInst* LlvmCode::call_instruction(const void* f, WordKind result, std::span<const Word> words) {
  std::vector<llvm::Value*> values;
  std::vector<llvm::Type*> types;
  for (const Word& w : words) {
    values.push_back(value(w));
    types.push_back(value(w)->getType());
  }
  return builder_.CreateCall(llvm::FunctionType::get(type(result), types, false), value(address(f)), values);
}

Word LlvmCode::call(const void* f, WordKind result, std::span<const Word> words) {
  return {call_instruction(f, result, words)};
}

Word LlvmCode::call_pure(const void* f, WordKind result, std::span<const Word> words) {
  llvm::CallInst* made = call_instruction(f, result, words);
  made->setDoesNotAccessMemory();
  made->setDoesNotThrow();
  made->addFnAttr(llvm::Attribute::WillReturn);
  return {made};
}

// ---- flow ----------------------------------------------------------------------------------------------------------------

Code::Label LlvmCode::label() {
  labels_.push_back(llvm::BasicBlock::Create(builder_.getContext()));
  return Label(labels_.size() - 1);
}

llvm::BasicBlock* LlvmCode::block(Label l) { return labels_[std::size_t(l)]; }
void LlvmCode::jump(Label to) { builder_.CreateBr(block(to)); }
void LlvmCode::branch(Word truth, Label yes, Label no) { builder_.CreateCondBr(value(truth), block(yes), block(no)); }

void LlvmCode::begin(Label l) {
  // Counted now and then: each count goes through the whole function.
  if (++begun_ % 1024 == 0 && function_->getInstructionCount() > most_instructions)
    throw Error("the shaders are too large to be compiled");
  block(l)->insertInto(function_);
  builder_.SetInsertPoint(block(l));
}

}  // namespace etendue::osl
