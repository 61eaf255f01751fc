// The compiler of groups: their layers' code in LLVM's intermediate form is improved and translated for this processor.

#include <llvm/Analysis/CGSCCPassManager.h>
#include <llvm/Analysis/LoopAnalysisManager.h>
#include <llvm/ExecutionEngine/Orc/LLJIT.h>
#include <llvm/ExecutionEngine/Orc/RTDyldObjectLinkingLayer.h>
#include <llvm/ExecutionEngine/SectionMemoryManager.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/Target/TargetMachine.h>

#include <cstdlib>
#include <mutex>

#include "etendue/core/error.h"
#include "llvm_code.h"

namespace etendue::osl {
namespace {

using llvm::orc::LLJIT;

[[noreturn]] void fail(llvm::Error error) { throw Error("shaders cannot be compiled: " + llvm::toString(std::move(error))); }

template <class T>
T value_or_fail(llvm::Expected<T> e) {
  if (!e) fail(e.takeError());
  return std::move(*e);
}

class LlvmGroupCode final : public GroupCode {
 public:
  explicit LlvmGroupCode(std::unique_ptr<LLJIT> jit) : jit_(std::move(jit)) {}
  LLJIT& jit() { return *jit_; }

 private:
  std::unique_ptr<LLJIT> jit_;
};

/// Short: shaders are small, and compiled while a picture is waited for. Variables become registers, what is constant is
/// computed, loops with few steps are unrolled, the rest is cleaned up. No pass changes the result of arithmetic.
constexpr const char* passes =
    "function(sroa,early-cse<memssa>,simplifycfg,instcombine<no-verify-fixpoint>,"
    "loop-mssa(loop-rotate,licm),loop(indvars,loop-deletion,loop-unroll-full),sroa,"
    "early-cse<memssa>,gvn,instcombine<no-verify-fixpoint>,dse,simplifycfg,slp-vectorizer,adce)";

void improve(llvm::Module& module, llvm::TargetMachine& target) {
  llvm::LoopAnalysisManager loops;
  llvm::FunctionAnalysisManager functions;
  llvm::CGSCCAnalysisManager components;
  llvm::ModuleAnalysisManager modules;
  llvm::PassBuilder builder(&target);
  builder.registerModuleAnalyses(modules);
  builder.registerCGSCCAnalyses(components);
  builder.registerFunctionAnalyses(functions);
  builder.registerLoopAnalyses(loops);
  builder.crossRegisterProxies(loops, functions, components, modules);
  llvm::ModulePassManager manager;
  if (auto error = builder.parsePassPipeline(manager, passes)) fail(std::move(error));
  manager.run(module, modules);
}

class LlvmMachine final : public Machine {
 public:
  std::unique_ptr<GroupCode> compile(const CodeRequest& request) const override {
    static std::once_flag once;
    std::call_once(once, [] {
      llvm::InitializeNativeTarget();
      llvm::InitializeNativeTargetAsmPrinter();
    });
    auto builder = value_or_fail(llvm::orc::JITTargetMachineBuilder::detectHost());
    builder.getOptions().AllowFPOpFusion = llvm::FPOpFusion::Strict;
    builder.setCodeGenOptLevel(llvm::CodeGenOptLevel::Default);
    auto target = value_or_fail(builder.createTargetMachine());

    auto context = std::make_unique<llvm::LLVMContext>();
    auto module = std::make_unique<llvm::Module>(request.name, *context);
    module->setDataLayout(target->createDataLayout());
    module->setTargetTriple(target->getTargetTriple().str());
    for (int i = 0; i < request.layers; ++i) {
      LlvmCode code(*module, layer_name(i), request.layout);
      request.emit(code, i);
      code.finish();
    }
    for (llvm::Function& function : *module) {
      function.addFnAttr("target-cpu", target->getTargetCPU());
      function.addFnAttr("target-features", target->getTargetFeatureString());
    }
    const char* dump = std::getenv("ETENDUE_OSL_DUMP");  // "before", "after": prints the intermediate form
    const std::string_view when = dump ? dump : "";
    if (when == "before") module->print(llvm::errs(), nullptr);
    if (!when.empty() && llvm::verifyModule(*module, &llvm::errs())) throw Error("the code of the shaders is malformed");
    improve(*module, *target);
    if (when == "after") module->print(llvm::errs(), nullptr);
    return link(std::move(builder), std::move(context), std::move(module), request.layers);
  }

 private:
  static std::string layer_name(int i) { return "layer_" + std::to_string(i); }

  static std::unique_ptr<GroupCode> link(llvm::orc::JITTargetMachineBuilder builder, std::unique_ptr<llvm::LLVMContext> context,
                                         std::unique_ptr<llvm::Module> module, int layers) {
    llvm::orc::LLJITBuilder jit_builder;
    jit_builder.setJITTargetMachineBuilder(std::move(builder));
    // There is nothing to be initialized in shaders.
    jit_builder.setPlatformSetUp(llvm::orc::setUpInactivePlatform);
    // This layer registers the tables by which exceptions find their way through the code.
    jit_builder.setObjectLinkingLayerCreator([](llvm::orc::ExecutionSession& session, const llvm::Triple&) {
      return std::make_unique<llvm::orc::RTDyldObjectLinkingLayer>(
          session, [] { return std::make_unique<llvm::SectionMemoryManager>(); });
    });
    auto made = std::make_unique<LlvmGroupCode>(value_or_fail(jit_builder.create()));
    LLJIT& jit = made->jit();
    if (auto error = jit.addIRModule(llvm::orc::ThreadSafeModule(std::move(module), std::move(context))))
      fail(std::move(error));
    for (int i = 0; i < layers; ++i) made->layers.push_back(value_or_fail(jit.lookup(layer_name(i))).toPtr<LayerCode>());
    return made;
  }
};

const struct Announced {
  Announced() {
    static const LlvmMachine machine;
    announce_machine(machine, ETENDUE_VERSION);
  }
} announced_here;

}  // namespace
}  // namespace etendue::osl
