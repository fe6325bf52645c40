// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace vdb_shell
{

/// Base of everything that this library throws on purpose.
/// The message always names the file or argument, the element, its value and the limit it broke.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An option or an argument that contradicts its documented precondition.
struct InvalidOption : Error {
    using Error::Error;
};

/// A file that cannot be read, or that is not what its format demands.
struct ReadError : Error {
    using Error::Error;
};

/// A readable mesh or grid that the stages cannot work with: open, non-manifold, too coarse...
struct GeometryError : Error {
    using Error::Error;
};

/// A file that cannot be written. Whatever stood at its path before is still there, untouched.
struct WriteError : Error {
    using Error::Error;
};

/// The caller's interrupter asked to stop.
struct Cancelled : Error {
    Cancelled() : Error("cancelled") {}
};

} // namespace vdb_shell
