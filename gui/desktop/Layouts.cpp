#include "gui/desktop/Layouts.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCryptographicHash>
#include <QDir>
#include <QFileInfo>
#include <QJsonDocument>
#include <QObject>
#include <QSettings>
#include <algorithm>
#include <cstdio>

namespace hermes::desktop {
namespace {

constexpr qint64 largestFile = 1 << 20; // bytes; a window with all panels and a hundred plots has 20,000
constexpr int mostRobots = 200;

QString tr(const char *text) {
    return QObject::tr(text);
}

/// What QSettings makes a value of that is no text.
bool isBuilt(const QByteArray &text) {
    return text.contains("@Variant(") || text.contains("@DateTime(");
}

/// A section, or a key with a value whose quotes end with it. QSettings says that it found anything else only
/// to the first who reads the file, or reads on in the next line.
bool isWhole(const QByteArray &line) {
    if (line.startsWith('['))
        return line.endsWith(']');
    const int equals = line.indexOf('=');
    bool isQuoted = false;
    for (int i = equals + 1; i < line.size(); ++i) {
        if (line[i] == '"')
            isQuoted = !isQuoted;
        else if (line[i] == '\\' && ++i == line.size())
            return false;
    }
    return equals >= 0 && !isQuoted && !line.left(equals).contains('"');
}

/// Lines of an ini file that this program may have written. What QSettings would build from "@Variant" is
/// never what was kept.
bool isOurs(const QByteArray &text) {
    if (text.contains('\0') || isBuilt(text))
        return false;
    bool hasGroup = false, hasLine = false;
    for (const QByteArray &line : text.split('\n')) {
        const QByteArray one = line.trimmed();
        if (one.isEmpty() || one.startsWith(';'))
            continue;
        hasLine = true;
        hasGroup = hasGroup || one == "[window]" || one == "[layouts]" || one == "[robots]";
        if (!isWhole(one))
            return false;
    }
    return hasGroup || !hasLine;
}

/// Keys and values in turn: a key of the file could not have all characters.
QStringList listOf(const QMap<QString, QString> &pairs) {
    QStringList list;
    for (auto one = pairs.begin(); one != pairs.end(); ++one)
        list << one.key() << one.value();
    return list;
}

QMap<QString, QString> pairsIn(const QVariant &value) {
    const QStringList list = value.toStringList().mid(0, 2 * mostRobots);
    QMap<QString, QString> pairs;
    for (int i = 0; i + 1 < list.size(); i += 2)
        pairs[list[i]] = list[i + 1];
    return pairs;
}

QByteArray checkOf(const Layouts::Layout &layout) {
    QCryptographicHash hash(QCryptographicHash::Sha256);
    hash.addData(layout.geometry);
    hash.addData(layout.state);
    return hash.result().toHex();
}

/// Where a symbolic link leads to, which stays one.
QString targetOf(QString file) {
    for (int links = 0; links < 40 && QFileInfo(file).isSymLink(); ++links)
        file = QFileInfo(file).symLinkTarget();
    return file;
}

/// Never empty.
QByteArray hashOf(const QByteArray &text) {
    return QCryptographicHash::hash(text, QCryptographicHash::Sha256);
}

QString nameOf(const QVariant &text) {
    return shortLine(text.toString().trimmed(), Layouts::longestName);
}

} // namespace

QString compactText(const QJsonObject &object) {
    return QString::fromUtf8(QJsonDocument(object).toJson(QJsonDocument::Compact));
}

QJsonObject objectOf(const QVariant &text) {
    return QJsonDocument::fromJson(text.toString().toUtf8()).object();
}

Layouts::Layouts(const QString &file)
    : file_(targetOf(file)) {
    read();
    if (layouts_.empty())
        layouts_.push_back({tr("Usual"), {}});
    if (find(current_) == layouts_.end())
        current_ = layouts_.front().name;
}

QByteArray Layouts::fingerprintOf(const QString &file) {
    QFile content(file);
    return content.open(QIODevice::ReadOnly) ? hashOf(content.read(largestFile + 1)) : QByteArray();
}

void Layouts::read() {
    const QFileInfo info(file_);
    if (file_.isEmpty() || !info.exists())
        return;
    const auto refuse = [this](const QString &why) {
        problem_ = tr("The layout of the window and the robots are not kept: %1 %2").arg(file_, why);
    };
    if (!info.isFile())
        return refuse(tr("is no file"));
    QFile content(file_);
    if (!content.open(QIODevice::ReadOnly))
        return refuse(tr("cannot be read: %1").arg(content.errorString()));
    const QByteArray text = content.size() > largestFile ? QByteArray() : content.readAll();
    fingerprint_ = hashOf(text);
    if (content.size() > largestFile || !isOurs(text))
        return refuse(tr("is damaged, or was not written by this program. It is left as it is"));
    QSettings file(file_, QSettings::IniFormat);
    if (file.status() != QSettings::NoError)
        return refuse(tr("is damaged. It is left as it is"));
    readLayouts(file);
    robots_.addresses = file.value("robots/addresses").toStringList().mid(0, mostRobots);
    robots_.names = pairsIn(file.value("robots/names"));
    for (QString &name : robots_.names)
        name = nameOf(name);
    robots_.places = pairsIn(file.value("robots/places"));
    robots_.chosen = file.value("robots/chosen").toString();
    file.beginGroup("kept");
    for (const QString &key : file.allKeys())
        values_[key] = file.value(key).toString();
}

// Qt may crash at a state that is not as it wrote it.
void Layouts::readLayouts(QSettings &file) {
    const int count = qBound(0, file.beginReadArray("layouts"), most);
    for (int i = 0; i < count; ++i) {
        file.setArrayIndex(i);
        const QString name = nameOf(file.value("name"));
        if (name.isEmpty() || find(name) != layouts_.end())
            continue;
        Layout layout{file.value("geometry").toByteArray(), file.value("state").toByteArray(),
                      objectOf(file.value("plots"))};
        if (file.value("check").toByteArray() != checkOf(layout)) {
            layout.geometry = layout.state = {};
            damage_ = tr("The layout %1 is damaged: its panels are arranged as usual.").arg(name);
        }
        layouts_.push_back({name, layout});
    }
    file.endArray();
    current_ = nameOf(file.value("window/layout"));
}

std::vector<Layouts::Named>::iterator Layouts::find(const QString &name) {
    return std::find_if(layouts_.begin(), layouts_.end(),
                        [&name](const Named &one) { return one.name == name; });
}

QStringList Layouts::names() const {
    QStringList names;
    for (const Named &one : layouts_)
        names.append(one.name);
    return names;
}

Layouts::Layout Layouts::layout() const {
    for (const Named &one : layouts_)
        if (one.name == current_)
            return one.layout;
    return {};
}

void Layouts::setLayout(const Layout &layout) {
    put(find(current_)->layout, layout);
}

Result<void> Layouts::choose(const QString &name) {
    if (find(name) == layouts_.end())
        return Error(ErrorCode::InvalidParams, tr("There is no layout %1.").arg(shortLine(name)));
    put(current_, name);
    return {};
}

Result<void> Layouts::saveAs(const QString &name) {
    const QString wanted = nameOf(name.left(longestName));
    if (wanted.isEmpty())
        return Error(ErrorCode::InvalidParams, tr("A layout needs a name."));
    if (find(wanted) != layouts_.end())
        return Error(ErrorCode::InvalidParams, tr("There is a layout %1 already.").arg(wanted));
    if (int(layouts_.size()) >= most)
        return Error(ErrorCode::InvalidParams, tr("There are %1 layouts: delete one first.").arg(most));
    layouts_.push_back({wanted, layout()});
    put(current_, wanted);
    return {};
}

Result<void> Layouts::remove() {
    if (layouts_.size() < 2)
        return Error(ErrorCode::InvalidParams, tr("The last layout stays."));
    layouts_.erase(find(current_));
    put(current_, layouts_.front().name);
    return {};
}

Result<void> Layouts::save() const {
    if (file_.isEmpty())
        return {};
    if (!problem_.isEmpty())
        return Error(ErrorCode::InputOutput, problem_);
    const Error failed(ErrorCode::InputOutput,
                       tr("The layout of the window and the robots could not be written to %1").arg(file_));
    const QString fresh = file_ + ".new"; // so that a whole one is there at any time
    QDir().mkpath(QFileInfo(file_).absolutePath());
    QFile::remove(fresh);
    if (!write(fresh))
        return failed;
    QFile written(fresh);
    if (!written.open(QIODevice::ReadOnly))
        return failed;
    const qint64 size = written.size();
    if (size > largestFile || !isOurs(written.readAll())) {
        written.remove();
        return Error(ErrorCode::InputOutput,
                     tr("The layout of the window and the robots are not kept any more: %1")
                         .arg(size > largestFile
                                  ? tr("with buttons, plots and names it has %1, and may have %2.")
                                        .arg(sizeText(double(size)), sizeText(double(largestFile)))
                                  : tr("a name or a value is none that can be kept.")));
    }
    return std::rename(QFile::encodeName(fresh), QFile::encodeName(file_)) == 0 ? Result<void>() : failed;
}

bool Layouts::write(const QString &path) const {
    QSettings file(path, QSettings::IniFormat);
    file.beginWriteArray("layouts", int(layouts_.size()));
    for (std::size_t i = 0; i < layouts_.size(); ++i) {
        file.setArrayIndex(int(i));
        file.setValue("name", layouts_[i].name);
        file.setValue("geometry", layouts_[i].layout.geometry);
        file.setValue("state", layouts_[i].layout.state);
        file.setValue("check", checkOf(layouts_[i].layout));
        file.setValue("plots", compactText(layouts_[i].layout.plots));
    }
    file.endArray();
    file.setValue("window/layout", current_);
    file.setValue("robots/addresses", robots_.addresses);
    file.setValue("robots/names", listOf(robots_.names));
    file.setValue("robots/places", listOf(robots_.places));
    file.setValue("robots/chosen", robots_.chosen);
    for (auto one = values_.begin(); one != values_.end(); ++one)
        file.setValue("kept/" + one.key(), one.value());
    file.sync();
    return file.status() == QSettings::NoError;
}

} // namespace hermes::desktop
