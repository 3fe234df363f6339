#include "gui/desktop/Theme.h"

#include <QApplication>
#include <QFile>
#include <QHash>
#include <QPainter>
#include <QProxyStyle>
#include <QStyleFactory>
#include <QStyleOption>
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

/// Fusion, where that draws dark on dark: the button for what has no room in a tool bar, and empty ticks.
class ThemeStyle : public QProxyStyle {
public:
    ThemeStyle()
        : QProxyStyle(QStyleFactory::create("Fusion")) {}

    QIcon standardIcon(StandardPixmap which, const QStyleOption *option,
                       const QWidget *widget) const override {
        return which == SP_ToolBarHorizontalExtensionButton
                   ? theme::icon(QString("extension"))
                   : QProxyStyle::standardIcon(which, option, widget);
    }

    void drawPrimitive(PrimitiveElement element, const QStyleOption *option, QPainter *painter,
                       const QWidget *widget) const override {
        QProxyStyle::drawPrimitive(element, option, painter, widget);
        if (!theme::isDark() || (element != PE_IndicatorCheckBox && element != PE_IndicatorRadioButton))
            return;
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing, true);
        painter->setBrush(Qt::NoBrush);
        const bool isEnabled = option->state & State_Enabled;
        painter->setPen(option->palette.color(isEnabled ? QPalette::Active : QPalette::Disabled,
                                              isEnabled ? QPalette::PlaceholderText : QPalette::Mid));
        const QRectF box = QRectF(option->rect).adjusted(0.5, 0.5, -0.5, -0.5);
        if (element == PE_IndicatorCheckBox)
            painter->drawRoundedRect(box, 2, 2);
        else
            painter->drawEllipse(box);
        painter->restore();
    }
};

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

struct Look {
    const char *icon;
    QRgb light, dark;
};

constexpr Look lookOf(Condition condition) {
    switch (condition) {
    case Condition::Ready:
        return {"ready", 0x177531, 0x4cc36a};
    case Condition::Busy:
        return {"busy", 0x0b63c4, 0x58a6ff};
    case Condition::Warning:
        return {"warning", 0x8f5600, 0xe8a317};
    case Condition::Fault:
        return {"fault", 0xc4201d, 0xff6b62};
    case Condition::Unreachable:
        break;
    }
    return {"unreachable", 0x5c636a, 0x8b9299};
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
    const Look look = lookOf(condition);
    return isDark() ? look.dark : look.light;
}

void tint(QWidget &widget, QPalette::ColorRole role, std::optional<Condition> condition) {
    QPalette palette;
    if (condition)
        palette.setColor(role, colour(*condition));
    widget.setPalette(palette);
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
    return drawn(lookOf(condition).icon, colour(condition));
}

QIcon icon(const QString &name) {
    return drawn(name, QApplication::palette().color(QPalette::ButtonText));
}

} // namespace hermes::desktop::theme
