#include "daemons/seriallogger/SerialIndex.h"

#include <QtEndian>

namespace hermes::seriallogger::serialindex {

void encode(const Record &record, unsigned char *bytes) {
    qToLittleEndian<quint64>(record.offset, bytes);
    qToLittleEndian<qint64>(record.arrival.stamp_ns, bytes + 8);
    qToLittleEndian<qint64>(record.arrival.mono_ns, bytes + 16);
}

Record decode(const unsigned char *bytes) {
    return {qFromLittleEndian<quint64>(bytes),
            {qFromLittleEndian<qint64>(bytes + 8), qFromLittleEndian<qint64>(bytes + 16)}};
}

} // namespace hermes::seriallogger::serialindex
