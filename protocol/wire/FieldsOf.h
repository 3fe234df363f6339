#pragma once

class QJsonObject;

namespace hermes {

template <typename T>
class Fields;

/// The fields of a struct that travels: specialised beside it. Whoever writes, reads or describes it includes
/// Fields.h.
template <typename T>
const Fields<T> &fieldsOf();

/// How a value of the type T is written, read and described.
template <typename T, typename = void>
struct Type;

/// The JSON Schema of T.
template <typename T>
QJsonObject schemaOf();

} // namespace hermes
