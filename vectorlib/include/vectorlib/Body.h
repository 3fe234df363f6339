#pragma once

/// What stands before the bodies in vectorlib/src: nothing in the compiled library. With
/// VECTORLIB_HEADER_ONLY defined every header ends with its bodies, and they are inline.
#ifdef VECTORLIB_HEADER_ONLY
#define VECTORLIB_BODY inline
#define VECTORLIB_BODIES(source) source
#else
#define VECTORLIB_BODY
#define VECTORLIB_BODIES(source) "vectorlib/Body.h" // no more than this one
#endif
