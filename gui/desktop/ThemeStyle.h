#pragma once

#include "gui/desktop/Theme.h"

#include <QPainter>
#include <QProxyStyle>
#include <QStyleFactory>
#include <QStyleOption>

namespace hermes::desktop {

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

} // namespace hermes::desktop
