#pragma once

#include <QtTest>

/// The columns of a test's data and, called, one row of them: its name, then a value for each column.
template <typename... T>
class Rows {
public:
    template <typename... Names>
    explicit Rows(const Names &...columns) {
        static_assert(sizeof...(Names) == sizeof...(T), "each column has a name");
        (QTest::addColumn<T>(columns), ...);
    }

    void operator()(const char *name, const T &...values) const { (QTest::newRow(name) << ... << values); }
};

/// A column with a row for each text, named as it is.
template <typename T = QString>
void rowsOf(const char *column, std::initializer_list<const char *> texts) {
    const Rows<T> row(column);
    for (const char *const text : texts)
        row(text, T(text));
}

/// A column with the rows of its two values.
inline void falseAndTrue(const char *column, const char *no, const char *yes) {
    const Rows<bool> row(column);
    row(no, false);
    row(yes, true);
}

/// The column `seed` with a row for each from first to last.
template <typename T>
void rowsOfSeeds(T first, T last) {
    const Rows<T> row("seed");
    for (T seed = first; seed <= last; ++seed)
        row(qPrintable(QString("seed %1").arg(seed)), seed);
}

// FETCH(int, a, QString, b) is QFETCH of up to eight columns.
#define FETCH(...)                                                                                           \
    FETCH_COUNTED(__VA_ARGS__, FETCH_8, , FETCH_7, , FETCH_6, , FETCH_5, , FETCH_4, , FETCH_3, , FETCH_2,    \
                  , )                                                                                        \
    (__VA_ARGS__)
#define FETCH_COUNTED(a, A, b, B, c, C, d, D, e, E, f, F, g, G, h, H, macro, ...) macro
#define FETCH_2(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    QFETCH(__VA_ARGS__)
#define FETCH_3(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_2(__VA_ARGS__)
#define FETCH_4(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_3(__VA_ARGS__)
#define FETCH_5(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_4(__VA_ARGS__)
#define FETCH_6(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_5(__VA_ARGS__)
#define FETCH_7(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_6(__VA_ARGS__)
#define FETCH_8(T, name, ...)                                                                                \
    QFETCH(T, name);                                                                                         \
    FETCH_7(__VA_ARGS__)
