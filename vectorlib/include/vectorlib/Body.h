#pragma once

/// What stands before the bodies in vectorlib/src: nothing in the compiled library. With
/// VECTORLIB_HEADER_ONLY defined every header includes its bodies, and they are inline.
#ifdef VECTORLIB_HEADER_ONLY
#define VECTORLIB_BODY inline
#else
#define VECTORLIB_BODY
#endif
