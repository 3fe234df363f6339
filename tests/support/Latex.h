#pragma once

#include <QFileInfo>
#include <QProcess>
#include <QStandardPaths>

namespace hermes {

/// pdflatex with the packages that LatexExport's documents need, where it is installed; else why it is not
/// used.
class Latex {
public:
    Latex() {
        if (QStandardPaths::findExecutable("pdflatex").isEmpty()) {
            missing_ = "pdflatex is not installed: the documents were not compiled";
            return;
        }
        for (const char *file : {"tikz.sty", "longtable.sty", "geometry.sty"}) {
            QProcess find;
            find.start("kpsewhich", {file});
            if (!find.waitForFinished(30000) || find.readAllStandardOutput().trimmed().isEmpty())
                missing_ = QByteArray(file) + " is not installed: the documents were not compiled";
        }
    }
    const QByteArray &missing() const { return missing_; } ///< empty when all is there

    /// What is wrong with a document: the end of the log when it does not compile, or what is cut off.
    static QByteArray fault(const QString &document) {
        QProcess process;
        process.setWorkingDirectory(QFileInfo(document).path());
        process.start("pdflatex",
                      {"-interaction=nonstopmode", "-halt-on-error", QFileInfo(document).fileName()});
        if (!process.waitForFinished(120000))
            return document.toUtf8() + ": not done in two minutes";
        const QByteArray log = process.readAllStandardOutput();
        if (process.exitCode() != 0)
            return document.toUtf8() + ": " + log.right(2000);
        const int wide = log.indexOf("Overfull");
        return wide < 0 ? QByteArray() : document.toUtf8() + ": " + log.mid(wide, 200);
    }

private:
    QByteArray missing_;
};

} // namespace hermes
