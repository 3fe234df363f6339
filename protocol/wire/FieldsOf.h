#pragma once

namespace hermes {

template <typename T>
class Fields;

/// The fields of a struct that travels: specialised beside it. Whoever writes or reads it includes Fields.h.
template <typename T>
const Fields<T> &fieldsOf();

} // namespace hermes
