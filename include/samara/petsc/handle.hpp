// Owners of PETSc and SLEPc objects, and the check of their calls. Only the code of this file
// destroys them.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include <petscksp.h>
#include <petscmat.h>
#include <petscsnes.h>
#include <petscts.h>
#include <petscvec.h>
#include <slepceps.h>

namespace samara::petsc {

/// Throws an InternalError with place and PETSc's message where `code` is not zero. (`file` and
/// `line` are the caller's; clang 14 has no std::source_location.)
void check(PetscErrorCode code, const char* file = __builtin_FILE(), int line = __builtin_LINE());

/// Sole owner of a PETSc object (Vec, Mat, KSP, SNES, TS, EPS, FN, IS); moves, never copies.
template <class Object>
class Handle {
 public:
  Handle() = default;
  explicit Handle(Object object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { destroy(); }

  Object get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }

  /// For PETSc's create calls: destroys the held object and returns the address to fill.
  Object* fill() {
    destroy();
    return &object_;
  }

 private:
  void destroy() noexcept {
    if (object_ == nullptr) return;
    if constexpr (std::is_same_v<Object, Vec>) VecDestroy(&object_);
    if constexpr (std::is_same_v<Object, Mat>) MatDestroy(&object_);
    if constexpr (std::is_same_v<Object, KSP>) KSPDestroy(&object_);
    if constexpr (std::is_same_v<Object, SNES>) SNESDestroy(&object_);
    if constexpr (std::is_same_v<Object, TS>) TSDestroy(&object_);
    if constexpr (std::is_same_v<Object, EPS>) EPSDestroy(&object_);
    if constexpr (std::is_same_v<Object, FN>) FNDestroy(&object_);
    if constexpr (std::is_same_v<Object, IS>) ISDestroy(&object_);
    if constexpr (std::is_same_v<Object, VecScatter>) VecScatterDestroy(&object_);
    object_ = nullptr;
  }

  Object object_ = nullptr;
};

/// A new sequential or distributed vector of zeros.
Handle<Vec> make_vector(MPI_Comm comm, PetscInt local_size, PetscInt size);

/// Read access to a vector's local values for the length of a scope.
class ReadView {
 public:
  explicit ReadView(Vec vector) : vector_(vector) { check(VecGetArrayRead(vector_, &values_)); }
  ~ReadView() { VecRestoreArrayRead(vector_, &values_); }
  ReadView(const ReadView&) = delete;
  ReadView& operator=(const ReadView&) = delete;
  const PetscScalar* data() const { return values_; }
  PetscScalar operator[](PetscInt i) const { return values_[i]; }

 private:
  Vec vector_;
  const PetscScalar* values_ = nullptr;
};

/// Copy of a vector's local values.
std::vector<double> values_of(Vec vector);

/// Write access to a vector's local values for the length of a scope.
class WriteView {
 public:
  explicit WriteView(Vec vector) : vector_(vector) { check(VecGetArray(vector_, &values_)); }
  ~WriteView() { VecRestoreArray(vector_, &values_); }
  WriteView(const WriteView&) = delete;
  WriteView& operator=(const WriteView&) = delete;
  PetscScalar* data() const { return values_; }
  PetscScalar& operator[](PetscInt i) const { return values_[i]; }

 private:
  Vec vector_;
  PetscScalar* values_ = nullptr;
};

}  // namespace samara::petsc
