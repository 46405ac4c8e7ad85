"""Pictures of the benchmarks: SVG as text, from numbers alone. The same numbers make the same file, byte for byte."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 720, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 20, 50, 60
COLOURS = ['#1f6fb2', '#c8553d', '#5a8f3c', '#8a6fb0', '#b58900', '#555555']
FONT = 'font-family="sans-serif"'


def number(value):
    """Coordinates with one digit, labels without a superfluous one."""
    text = '%.1f' % value
    return text[:-2] if text.endswith('.0') else text


def label(value):
    """A tick as people write it: 0.2, 5, 1500."""
    return '%g' % round(value, 10)


def ticks(most):
    """Round numbers from 0 to at least `most`, at most six steps."""
    if most <= 0:
        return [0, 1]
    step = 10.0 ** math.floor(math.log10(most / 5.0))
    for factor in (1, 2, 5, 10):
        if step * factor * 6 >= most:
            step *= factor
            break
    return [step * index for index in range(int(math.ceil(most / step - 1e-9)) + 1)]


class Axes:
    """Where a point of the data lies in the picture. Both axes begin at 0, or are spaced by rank (`names`)."""

    def __init__(self, most_x, most_y, names=None):
        self.names = names
        self.x_ticks = ticks(most_x) if names is None else list(range(len(names)))
        self.y_ticks = ticks(most_y)

    def x(self, value):
        inside = WIDTH - LEFT - RIGHT
        if self.names is not None:
            return LEFT + inside * (value + 0.5) / len(self.names)
        return LEFT + inside * value / self.x_ticks[-1]

    def y(self, value):
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * value / self.y_ticks[-1]

    def draw(self, title, x_title, y_title):
        yield '<text x="%d" y="20" font-size="15" %s>%s</text>' % (LEFT, FONT, escape(title))
        for tick in self.y_ticks:
            y = number(self.y(tick))
            yield '<line x1="%d" y1="%s" x2="%d" y2="%s" stroke="#dddddd"/>' % (LEFT, y, WIDTH - RIGHT, y)
            yield '<text x="%d" y="%s" font-size="11" text-anchor="end" %s>%s</text>' % (
                LEFT - 6, number(self.y(tick) + 4), FONT, label(tick))
        for tick in self.x_ticks:
            text = label(tick) if self.names is None else self.names[tick]
            yield '<text x="%s" y="%d" font-size="11" text-anchor="middle" %s>%s</text>' % (
                number(self.x(tick)), HEIGHT - BOTTOM + 16, FONT, escape(text))
        yield '<line x1="%d" y1="%d" x2="%d" y2="%d" stroke="black"/>' % (
            LEFT, HEIGHT - BOTTOM, WIDTH - RIGHT, HEIGHT - BOTTOM)
        yield '<text x="%d" y="%d" font-size="12" text-anchor="middle" %s>%s</text>' % (
            (LEFT + WIDTH - RIGHT) // 2, HEIGHT - 22, FONT, escape(x_title))
        yield '<text x="16" y="%d" font-size="12" text-anchor="middle" transform="rotate(-90 16 %d)" %s>%s</text>' % (
            (TOP + HEIGHT - BOTTOM) // 2, (TOP + HEIGHT - BOTTOM) // 2, FONT, escape(y_title))


def legend(names):
    for index, name in enumerate(names):
        x = LEFT + 10 + 158 * (index % 4)
        y = 36 + 14 * (index // 4)
        yield '<rect x="%d" y="%d" width="10" height="10" fill="%s"/>' % (x, y - 9, COLOURS[index % len(COLOURS)])
        yield '<text x="%d" y="%d" font-size="11" %s>%s</text>' % (x + 14, y, FONT, escape(name))


def document(parts):
    return '\n'.join(['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d">' %
                      (WIDTH, HEIGHT, WIDTH, HEIGHT), '<rect width="100%" height="100%" fill="white"/>'] +
                     list(parts) + ['</svg>', ''])


def lines(title, x_title, y_title, series, names=None):
    """A picture of lines through points. series: list of (name, [(x, y)]); names: words for x = 0, 1, 2, ..."""
    points = [point for _, of_one in series for point in of_one]
    axes = Axes(max((x for x, _ in points), default=1), max((y for _, y in points), default=1), names)
    parts = list(axes.draw(title, x_title, y_title)) + list(legend([name for name, _ in series]))
    for index, (_, of_one) in enumerate(series):
        colour = COLOURS[index % len(COLOURS)]
        path = ' '.join('%s,%s' % (number(axes.x(x)), number(axes.y(y))) for x, y in of_one)
        parts.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="2"/>' % (path, colour))
        parts += ['<circle cx="%s" cy="%s" r="3" fill="%s"/>' % (number(axes.x(x)), number(axes.y(y)), colour)
                  for x, y in of_one]
    return document(parts)


def bars(title, x_title, y_title, series, names):
    """Histograms beside each other: series: list of (name, [value per bin]); names: one per bin."""
    axes = Axes(1, max((value for _, values in series for value in values), default=1), names)
    parts = list(axes.draw(title, x_title, y_title)) + list(legend([name for name, _ in series]))
    room = (WIDTH - LEFT - RIGHT) / len(names) * 0.8
    width = room / len(series)
    for index, (_, values) in enumerate(series):
        for place, value in enumerate(values):
            if value > 0:
                top = axes.y(value)
                parts.append('<rect x="%s" y="%s" width="%s" height="%s" fill="%s"/>' % (
                    number(axes.x(place) - room / 2 + width * index), number(top), number(width),
                    number(HEIGHT - BOTTOM - top), COLOURS[index % len(COLOURS)]))
    return document(parts)
