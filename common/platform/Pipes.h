#pragma once

#include <cstdio>

namespace hermes {

/// Makes writing to a pipe whose reader has gone an error (EPIPE) instead of the program's end.
void outliveClosedPipes();

/// The stream is a pipe that nobody reads any more, also where nothing was written. On Windows only a write
/// finds that out: always false.
bool isReaderGone(std::FILE *stream);

/// A stream of bytes into a file that is open for writing, behind a descriptor of the C library.
std::FILE *streamInto(int descriptor);

} // namespace hermes
