#pragma once

#include "protocol/jsonrpc/RpcError.h"
#include "vectorlib/error/Result.h"

namespace hermes {

/// What failed: a code for programs, a sentence for people, optional data. The same on the wire and inside.
using Error = RpcError;

template <typename T>
using Result = vectorlib::Result<T, Error>;

} // namespace hermes
