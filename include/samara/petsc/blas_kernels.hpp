// The processor kernels of the BLAS library.
#pragma once

#include <string>

namespace samara::petsc {

/// Lets OpenBLAS use kernels with the widest vector instructions that this processor can execute. A
/// processor newer than the library gets kernels without AVX by default. Nothing changes with
/// another BLAS, where `OPENBLAS_CORETYPE` is set, and where the library's own choice is as good.
/// To be called before another thread may use BLAS: the library has no kernels for a moment.
void choose_blas_kernels();

/// The BLAS library and its kernels as text, e.g. "OpenBLAS 0.3.21, SkylakeX"; "BLAS" for a library
/// that does not tell.
std::string blas_version();

}  // namespace samara::petsc
