// FunctionRef<R(Args...)>: a reference to a callable, as two pointers. For parameters only: it must not outlive the
// callable.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace gyre {

template <class Signature>
class FunctionRef;

template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  template <class Fn>
  requires(!std::is_same_v<std::remove_cvref_t<Fn>, FunctionRef> &&
           !std::is_function_v<std::remove_pointer_t<std::remove_cvref_t<Fn>>> &&
           std::is_invocable_r_v<R, Fn&, Args...>) FunctionRef(Fn&& fn) {
    using Object = std::remove_reference_t<Fn>;
    target_.object = const_cast<void*>(static_cast<const void*>(std::addressof(fn)));
    call_ = [](Target target, Args... args) -> R {
      return static_cast<R>((*static_cast<Object*>(target.object))(std::forward<Args>(args)...));
    };
  }

  // A plain function; not null.
  FunctionRef(R (*function)(Args...)) {
    target_.function = function;
    call_ = [](Target target, Args... args) -> R { return target.function(std::forward<Args>(args)...); };
  }

  R operator()(Args... args) const { return call_(target_, std::forward<Args>(args)...); }

 private:
  union Target {
    void* object;
    R (*function)(Args...);
  };

  Target target_;
  R (*call_)(Target, Args...);
};

}  // namespace gyre
