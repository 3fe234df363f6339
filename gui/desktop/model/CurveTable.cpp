#include "gui/desktop/model/CurveTable.h"

#include "common/files/SavedFile.h"

#include <charconv>

namespace hermes::desktop {
namespace {

/// Quoted where it could be taken for something else.
QByteArray cell(QString text) {
    if (text.contains(',') || text.contains('"') || text.contains('\n') || text.contains('\r'))
        text = '"' + text.replace('"', "\"\"") + '"';
    return text.toUtf8();
}

/// Short, and the same number when it is read again.
void append(QByteArray &line, double number) {
    char text[32];
    line.append(text, int(std::to_chars(text, text + sizeof text, number).ptr - text));
}

} // namespace

Result<void> writeCurves(const QString &file, const std::vector<KeptCurve> &curves) {
    SavedFile out(file);
    if (const auto begun = out.begin(); !begun)
        return begun;
    out.write("stamp,daemon,topic,field,value,unit\n");
    for (const KeptCurve &curve : curves) {
        const QByteArray names =
            ',' + cell(curve.daemon) + ',' + cell(curve.field.topic) + ',' + cell(curve.field.path) + ',';
        const QByteArray unit = ',' + cell(curve.unit) + '\n';
        for (const QPointF &sample : curve.samples) {
            QByteArray line;
            append(line, sample.x());
            line.append(names);
            append(line, sample.y());
            out.write(line.append(unit));
        }
    }
    return out.commit();
}

} // namespace hermes::desktop
