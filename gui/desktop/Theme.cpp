#include "gui/desktop/Theme.h"

#include "gui/desktop/ThemeStyle.h"

#include <QApplication>
#include <QFile>
#include <QHash>
#include <QPainter>
#include <QStyle>
#include <QSvgRenderer>
#include <utility>

// The icons are in a library, which has to be asked for them by name.
static void loadIcons() {
    Q_INIT_RESOURCE(icons);
}

namespace hermes::desktop::theme {
namespace {

/// The icons are drawn with "currentColor", which becomes a colour here.
QIcon drawn(const QString &name, const QColor &colour) {
    static QHash<QString, QIcon> known;
    const QString key = name + colour.name();
    if (known.contains(key))
        return known.value(key);
    QFile file(":/icons/" + name + ".svg");
    if (!file.open(QIODevice::ReadOnly))
        return {};
    const QByteArray svg = file.readAll();
    const QColor onChosen = QApplication::palette().color(QPalette::HighlightedText);
    QIcon icon;
    for (const auto &[mode, ink] : {std::pair(QIcon::Normal, colour), std::pair(QIcon::Selected, onChosen)}) {
        QSvgRenderer renderer(QByteArray(svg).replace("currentColor", ink.name().toLatin1()));
        for (const int size : {16, 24, 32, 48}) {
            QPixmap picture(size, size);
            picture.fill(Qt::transparent);
            QPainter painter(&picture);
            renderer.render(&painter);
            painter.end();
            icon.addPixmap(picture, mode);
        }
    }
    known.insert(key, icon);
    return icon;
}

QPalette darkPalette() {
    QPalette palette;
    const QColor window(0x23, 0x26, 0x29), base(0x1b, 0x1e, 0x20), text(0xea, 0xec, 0xee),
        grey(0x84, 0x88, 0x8c);
    palette.setColor(QPalette::Window, window);
    palette.setColor(QPalette::Base, base);
    palette.setColor(QPalette::AlternateBase, window);
    palette.setColor(QPalette::Button, QColor(0x31, 0x36, 0x3b));
    palette.setColor(QPalette::ToolTipBase, QColor(0x31, 0x36, 0x3b));
    for (const auto role :
         {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText})
        palette.setColor(role, text);
    palette.setColor(QPalette::BrightText, Qt::white);
    palette.setColor(QPalette::PlaceholderText, grey);
    palette.setColor(QPalette::Highlight, QColor(0x2f, 0x7f, 0xc4));
    palette.setColor(QPalette::HighlightedText, Qt::white);
    palette.setColor(QPalette::Link, QColor(0x6c, 0xb6, 0xf0));
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, grey);
    return palette;
}

QPalette lightPalette() {
    QPalette palette = QApplication::style()->standardPalette();
    palette.setColor(QPalette::PlaceholderText, QColor(0x5c, 0x63, 0x6a)); // else labels do not show it
    return palette;
}

const char *iconOf(Condition condition) {
    switch (condition) {
    case Condition::Ready:
        return "ready";
    case Condition::Busy:
        return "busy";
    case Condition::Warning:
        return "warning";
    case Condition::Fault:
        return "fault";
    case Condition::Unreachable:
        break;
    }
    return "unreachable";
}

} // namespace

void apply() {
    loadIcons();
    QApplication::setStyle(new ThemeStyle);
    const QByteArray setting = qgetenv("HERMES_THEME");
    const bool dark = setting == "dark" || (setting != "light" && isDark());
    QApplication::setPalette(dark ? darkPalette() : lightPalette());
}

bool isDark() {
    return QApplication::palette().color(QPalette::Window).lightness() < 128;
}

QColor colour(Condition condition) {
    const bool dark = isDark();
    switch (condition) {
    case Condition::Ready:
        return dark ? QColor(0x4c, 0xc3, 0x6a) : QColor(0x17, 0x75, 0x31);
    case Condition::Busy:
        return dark ? QColor(0x58, 0xa6, 0xff) : QColor(0x0b, 0x63, 0xc4);
    case Condition::Warning:
        return dark ? QColor(0xe8, 0xa3, 0x17) : QColor(0x8f, 0x56, 0x00);
    case Condition::Fault:
        return dark ? QColor(0xff, 0x6b, 0x62) : QColor(0xc4, 0x20, 0x1d);
    case Condition::Unreachable:
        break;
    }
    return dark ? QColor(0x8b, 0x92, 0x99) : QColor(0x5c, 0x63, 0x6a);
}

QColor mixed(const QColor &from, const QColor &to, double share) {
    const auto mix = [share](int a, int b) { return qRound(a + share * (b - a)); };
    return {mix(from.red(), to.red()), mix(from.green(), to.green()), mix(from.blue(), to.blue())};
}

QFont fixedFont() {
    QFont font("monospace", QApplication::font().pointSize());
    font.setStyleHint(QFont::Monospace);
    return font;
}

QIcon icon(Condition condition) {
    return drawn(iconOf(condition), colour(condition));
}

QIcon icon(const QString &name) {
    return drawn(name, QApplication::palette().color(QPalette::ButtonText));
}

} // namespace hermes::desktop::theme
