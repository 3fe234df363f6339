#pragma once

#include <cstdio>

namespace hermes {

/// Makes writing to a pipe whose reader has gone an error (EPIPE) instead of the program's end.
void outliveClosedPipes();

/// The stream is a pipe, socket or terminal whose other end has gone, also where nothing was written. On
/// Windows only a write finds that out: always false.
bool isOtherEndGone(std::FILE *stream);

/// A line can be written without waiting: the other end reads. On Windows always true.
bool takesMore(std::FILE *stream);

/// A stream of bytes into a file that is open for writing, behind a descriptor of the C library.
std::FILE *streamInto(int descriptor);

} // namespace hermes
