#pragma once

#include "daemons/scanmatcher/JournalBlock.h"

#include <QCborStreamWriter>

namespace hermes::scanmatcher {

/// The numbers of a block's tables; of a drive of one scan that saw one wall.
struct Tables {
    std::vector<double> scans{0, 0, 0, 0, 0, 0.5, 1}, keys{0, 1, 2, 0.5, 0, 0, 0, 1, 2, 0.5, 0, 0, 2};
    std::vector<double> motions, poses{1, 2, 0.5}, weights, since{0, 0, 0, 0, 0, 0, 0, 0};
    std::vector<double> progress{0, 0, 0, 0, 1};
    std::vector<float> edges{9, 1, 1, 3, 0, 0, 0, 1, 2, 1, 0.01F}, points{0, 1, 2, 1};

    /// Another scan, a key scan with no points.
    Tables &addKey() {
        scans.insert(scans.end(), {1, 0, 0, 0, 0, 1, 0});
        keys.insert(keys.end(), {1, 1, 0, 0, 1, 0.1, 0.1, 2, 2, 0.5, 1, 0.1, 0});
        poses.insert(poses.end(), {2, 2, 0.5});
        return *this;
    }
    Tables &addMotion() {
        motions = {0, 1, 1, 0, 0, 100, 0, 0, 100, 0, 100, 0, 1};
        weights = {1};
        return *this;
    }
    QByteArray content() const {
        QByteArray bytes;
        QCborStreamWriter out(&bytes);
        out.startMap();
        put(out, "scans", scans);
        put(out, "edges", edges);
        put(out, "keys", keys);
        put(out, "points", points);
        put(out, "motions", motions);
        put(out, "poses", poses);
        put(out, "weights", weights);
        put(out, "since", since);
        put(out, "progress", progress);
        out.endMap();
        return bytes;
    }

private:
    template <typename T>
    static void put(QCborStreamWriter &out, const char *table, const std::vector<T> &numbers) {
        out.append(QLatin1String(table));
        out.append(QCborTag(sizeof(T) == 4 ? 85 : 86));
        out.appendByteString(reinterpret_cast<const char *>(numbers.data()),
                             qsizetype(numbers.size() * sizeof(T)));
    }
};

/// The item with which a journal begins.
inline QByteArray firstItem(const char *mark = journal::mark, quint64 version = journal::version) {
    QByteArray begin;
    QCborStreamWriter out(&begin);
    out.startMap();
    out.append(QLatin1String(mark));
    out.append(version);
    out.endMap();
    return journal::item(begin, true);
}

} // namespace hermes::scanmatcher
