#pragma once

#include <QtTest>

/// For what a failed check says: a value.
template <typename T>
QByteArray saying(const T &value) {
    return QString("%1").arg(value).toUtf8();
}

/// A text with values for %1, %2, ...
template <typename... T>
QByteArray saying(const char *text, const T &...values) {
    QString said(text);
    ((said = said.arg(values)), ...);
    return said.toUtf8();
}

// A check of a text, which is shown where it fails.
#define VERIFY_CONTAINS(text, part) QVERIFY2((text).contains(part), qPrintable(text))
#define VERIFY_STARTS(text, part) QVERIFY2((text).startsWith(part), qPrintable(text))
#define TRY_CONTAINS(text, part) QTRY_VERIFY2((text).contains(part), qPrintable(text))
#define TRY_STARTS(text, part) QTRY_VERIFY2((text).startsWith(part), qPrintable(text))
