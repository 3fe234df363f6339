#pragma once

#include <string_view>

// The first is of a real receiver, the second that of the published field lists.
inline const QByteArray
    realRmc("$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*05\r\n");
inline const QByteArray usualGga("$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n");

inline QByteArray toBytes(std::string_view text) {
    return QByteArray(text.data(), int(text.size()));
}
