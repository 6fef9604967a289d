"""Equations in plain text, as docs/theory.md has them, as MathML.

    R (P_dot + Omega x P)        products by blanks, x the cross product, a.b or a . b the scalar one
    C_ab, q_y_dot, u_hat, t_k+1  subscripts; _dot, _ddot, _hat and ~ stand above the letter
    Q^-1, d^(1/2), f*            superscripts
    (x_f - x_i)/dt               fractions
    sum_j, int, {V; Omega}       sums, integrals, columns

Words stay words. Two blanks or more separate the parts of a line.
"""

import html
import re

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "eps": "ε", "zeta": "ζ", "eta": "η", "theta": "θ",
    "kappa": "κ", "lambda": "λ", "mu": "μ", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ",
    "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Lambda": "Λ", "Phi": "Φ", "Omega": "Ω", "Psi": "Ψ",
}
FUNCTIONS = {"cos", "sin", "tan", "exp", "ln", "sqrt", "atan", "atan2", "det", "arg", "argmax", "min", "max", "Re", "Im",
             "FFT", "diag", "skew", "compose", "conj", "sign", "mean"}
NAMES = {"Cl", "Cd", "Cm", "Ac", "As", "Cinv", "dC", "dt", "dn", "PT", "N1"}
SIGNS = {"<=": "≤", ">=": "≥", "->": "→", "+-": "±", "-+": "∓", "+=": "+=", "...": "…", "!!": "!!", "-": "−", "*": "*"}
ACCENTS = {"dot": "˙", "ddot": "¨", "hat": "ˆ"}
OPEN, CLOSE = {"(": ")", "[": "]", "{": "}"}, {")", "]", "}"}
NUMBER = re.compile(r"\(\d+(?:\.\d+)?[a-z]?\)(?:(?:-|, ?)\(\d+[a-z]?\))*$")
SUBSCRIPT = r"(?:\([^()]*\)|\{[^{}]*\}|[A-Za-z0-9]+(?:,[A-Za-z0-9]+)*(?:[+-]1(?:/2)?(?![\d.]))?|-(?![\w(]))"
TOKEN = re.compile(
    rf"(?P<number>\d+(?:\.\d+)?)|(?P<name>[A-Za-z]+\d*(?:'|_{SUBSCRIPT})*(?:'*)(?:_{SUBSCRIPT})*)(?P<tilde>~?)"
    r"|(?P<sign><=|>=|->|\+-|-\+|\+=|\.\.\.|!!|[-+*/=<>|.,;:!~^_()\[\]{}'`])|(?P<blank> +)|(?P<other>.)")


SPACE = '<mspace width="0.22em"></mspace>'


# A symbol in running text: it has a subscript or a superscript, or a Greek name.
PROSE = re.compile(rf"(?<![\w`])(?:(?:{'|'.join(sorted(GREEK, key=len, reverse=True))})(?![A-Za-z])\d?|(?:d?[A-Za-z]|C[ldm]|Cinv|sum|xc|xs)\d?(?=[_^]))"
                   rf"(?:'|_{SUBSCRIPT})*(?:\^(?:-?\d+|-?[A-Za-z](?![A-Za-z])|\([^()]*\)))?")


class NotAnEquation(ValueError):
    """The text has a character or a form that is not known here."""


def element(name, *content, **attributes):
    words = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f"<{name}{words}>{''.join(content)}</{name}>"


def row(content):
    return content[0] if len(content) == 1 else element("mrow", *content)


def fenced(opening, inner, closing):
    """Content in brackets, which are tall only around what is tall."""
    stretchy = "true" if any(tall in part for part in inner for tall in ("<mfrac", "<munder", "<msqrt")) else "false"
    ends = [element("mo", end, fence="true", stretchy=stretchy) for end in (opening, closing)]
    return row([ends[0], *inner, ends[1]])


def letter(name):
    """Letters and digits of a symbol without its marks, and digits that are a subscript."""
    stem, digits = re.fullmatch(r"([A-Za-z]+)(\d*)", name).groups()
    if stem in GREEK:
        return element("mi", GREEK[stem]), digits
    if stem in FUNCTIONS:
        return element("mi", stem + digits, mathvariant="normal"), ""
    return element("mi", stem), digits


def is_word(name):
    """True for a word of the language and not a symbol."""
    if not re.fullmatch(r"[A-Za-z]+", name) or name in FUNCTIONS or name in GREEK or name in NAMES:
        return False
    if name in ("sum", "int") or len(name) == 1:
        return False
    return not (name[0] == "d" and (name[1:] in GREEK or name in ("dp", "dz", "df", "ds", "dt", "dr", "da", "dw", "dq")))


def subscript_of(text):
    text = text[1:-1] if text[0] in "({" else text
    return convert_inner(text) if re.search(r"[^A-Za-z]", text) or text in GREEK or len(text) == 1 else element("mi", text, mathvariant="normal")


def symbol(name, tilde):
    """A name with its subscripts, primes and accents."""
    parts = re.match(r"([A-Za-z]+\d*)(.*)$", name, re.S)
    marks = re.findall(rf"'|_{SUBSCRIPT}", parts[2])
    stem = re.sub(r"\d+$", "", parts[1])
    if stem[0] == "d" and (len(stem) == 2 or stem[1:] in GREEK) and name not in FUNCTIONS:
        return row([element("mi", "d"), symbol(name[1:], tilde)])
    if parts[1] in ("sum", "int"):
        sign = element("mo", "∑" if parts[1] == "sum" else "∫", largeop="true")
        below = [subscript_of(mark[1:]) for mark in marks]
        return element("munder", sign, row(below)) if below else sign
    base, digits = letter(parts[1])
    below = [element("mn", digits)] if digits else []
    primes = ""
    for mark in marks:
        if mark == "'":
            primes += "′"
        elif mark[1:] in ACCENTS:
            base = element("mover", base, element("mo", ACCENTS[mark[1:]], stretchy="false"), accent="true")
        else:
            below.append(subscript_of(mark[1:]))
    if tilde:
        base = element("mover", base, element("mo", "˜", stretchy="false"), accent="true")
    if below and primes:
        return element("msubsup", base, row(below), element("mo", primes))
    if below:
        return element("msub", base, row(below))
    return element("msup", base, element("mo", primes)) if primes else base


def tokens_of(text):
    found = []
    for match in TOKEN.finditer(text):
        kind = match.lastgroup if match.lastgroup != "tilde" else "name"
        if kind == "other":
            raise NotAnEquation(f"{match[0]} in {text}")
        found.append((kind, match["name"] if kind == "name" else match[0], match["tilde"]))
    return found


class Reader:
    """Reads a text of one cell. An item is (MathML, is an operand, inner MathML of a pair of brackets)."""

    def __init__(self, text):
        self.tokens = tokens_of(text)
        self.at = 0

    def peek(self, ahead=0):
        return self.tokens[self.at + ahead] if self.at + ahead < len(self.tokens) else ("end", "", "")

    def skip_blanks(self):
        blank = False
        while self.peek()[0] == "blank":
            self.at += 1
            blank = True
        return blank

    def next_solid(self):
        ahead = 0
        while self.peek(ahead)[0] == "blank":
            ahead += 1
        return self.peek(ahead)

    def is_cross(self, before):
        """True for an x between two operands: the cross product."""
        nearby = self.peek(1)[0] == "blank" and self.at > 0 and self.tokens[self.at - 1][0] == "blank"
        if not (nearby and before):
            return False
        kind, text, _ = self.peek(2)
        return kind in ("name", "number") and not is_word(text) or text in OPEN

    def read_all(self, closing=None):
        items = []
        while True:
            blank = self.skip_blanks()
            kind, text, _ = self.peek()
            if kind == "end":
                if closing:
                    raise NotAnEquation(f"no {closing}")
                break
            if text == closing:
                break
            if text in CLOSE:
                raise NotAnEquation(f"{text} without its bracket")
            if text == "/" and items and items[-1][1]:
                self.at += 1
                items.append(self.read_fraction(items, blank))
                continue
            item = self.read_item(items[-1] if items else None)
            if items and items[-1][1] and item[1] and blank:  # a product
                items.append((SPACE, False, None))
            items.append(item)
        return [item[0] for item in items]

    def read_fraction(self, items, is_wide):
        """A fraction. a b / c d with blanks divides the products, a b/c d without them b by c."""
        above = [items.pop()]
        while not is_wide and items and items[-1][1]:
            above.insert(0, items.pop())
        while is_wide and items and (items[-1][1] or items[-1][0] == SPACE or "∑" in items[-1][0] or "·" in items[-1][0]):
            above.insert(0, items.pop())
        self.skip_blanks()
        below = [self.read_item(None)]
        while is_wide and self.peek()[0] == "blank" and self.is_factor(self.peek(1)):
            self.skip_blanks()
            below += [(SPACE, False, None), self.read_item(below[-1])]
        parts = [part[0][2] or part[0][0] if len(part) == 1 else row([item[0] for item in part]) for part in (above, below)]
        return element("mfrac", *parts), True, None

    @staticmethod
    def is_factor(token):
        return token[0] in ("name", "number") and not is_word(token[1]) or token[1] in OPEN

    def read_item(self, before):
        item = self.read_base(before)
        return self.read_powers(item) if item[1] else item

    def read_base(self, before):
        kind, text, tilde = self.peek()
        follows_operand = before is not None and before[1]
        if kind == "name" and text == "x" and not tilde and self.is_cross(follows_operand):
            self.at += 1
            return element("mo", "×"), False, None
        if kind == "name" and is_word(text) and not tilde and self.peek(1)[1] not in ("^", "_"):
            return self.read_words()
        self.at += 1
        if kind == "number":
            return element("mn", text), True, None
        if kind == "name":
            return self.read_symbol(text, tilde)
        if text in OPEN:
            inner = self.read_all(OPEN[text])
            self.at += 1
            return fenced(text, inner, OPEN[text]), True, row(inner) if text != "{" and inner else None
        if text == ".":
            near = self.next_solid()
            if follows_operand and (near[0] in ("name", "number") or near[1] in OPEN):
                return element("mo", "·"), False, None
        if text in ".,;:":
            return element("mo", text, lspace="0", rspace="0.3em"), False, None
        if text == "/":
            return element("mo", "/"), False, None
        if text == "!" or text == "!!":
            return element("mo", text), True, None
        if text in "^_":
            raise NotAnEquation(f"a {text} without its letter")
        sign = SIGNS.get(text, text)
        if text == "|":
            inner = self.read_all("|")
            self.at += 1
            return fenced("|", inner, "|"), True, None
        form = {} if follows_operand or text not in "-+" else {"form": "prefix"}
        return element("mo", html.escape(sign), **form), False, None

    def read_words(self):
        text = "\u00a0" if self.at and self.tokens[self.at - 1][0] == "blank" else ""
        while True:
            text += self.peek()[1]
            self.at += 1
            between, following = self.peek()[1], self.peek(1)
            if (between == "-" or self.peek()[0] == "blank") and following[0] == "name" and is_word(following[1]):
                text += between[:1]
                self.at += 1
            else:
                break
        return element("mtext", text + ("\u00a0" if self.peek()[0] == "blank" else "")), False, None

    def read_symbol(self, text, tilde):
        base = symbol(text, tilde)
        if text.startswith("sum") and self.peek()[1] == "^":
            self.at += 1
            below = re.sub("^<munder>(.*)</munder>$", r"\1", base)
            return element("munderover", below, self.read_exponent()), False, None
        # A function and its argument are one operand of a fraction.
        if self.peek()[1] in ("(", "[") and re.match(r"[A-Za-z]", text) and not text.startswith(("sum", "int")):
            opening = self.peek()[1]
            self.at += 1
            inner = self.read_all(OPEN[opening])
            self.at += 1
            if text == "sqrt":
                return element("msqrt", *inner), True, None
            return row([base, fenced(opening, inner, OPEN[opening])]), True, None
        return base, not text.startswith(("sum", "int")), None

    def read_powers(self, item):
        base, _, inner = item
        while True:
            text = self.peek()[1]
            if text == "^":
                following = self.peek(1)
                is_hat = following[1] in ("^", ")", "") or (following[1] == "(" and base == letter("Z")[0])
                self.at += 1
                if is_hat:
                    base = element("mover", base, element("mo", "ˆ", stretchy="false"), accent="true")
                    inner = None
                    if self.peek()[1] == "(":
                        self.at += 1
                        argument = self.read_all(")")
                        self.at += 1
                        base = row([base, element("mo", "("), *argument, element("mo", ")")])
                    continue
                base, inner = element("msup", base, self.read_exponent()), None
            elif text == "*" and self.peek(1)[0] in ("blank", "end") or text == "*" and self.peek(1)[1] in ")],":
                self.at += 1
                base, inner = element("msup", base, element("mo", "*")), None
            elif text == "_":
                self.at += 1
                base, inner = element("msub", base, self.read_exponent()), None
            elif text == "'":
                self.at += 1
                base, inner = element("msup", base, element("mo", "′")), None
            elif text == "." and self.is_factor(self.peek(1)):
                self.at += 1
                base, inner = row([base, element("mo", "·"), self.read_item((base, True, None))[0]]), None
            elif text in ("!", "!!"):
                self.at += 1
                base, inner = row([base, element("mo", text)]), None
            else:
                return base, True, inner

    def read_exponent(self):
        sign = []
        if self.peek()[1] in ("-", "+"):
            sign = [element("mo", SIGNS.get(self.peek()[1], "+"), form="prefix")]
            self.at += 1
        kind, text, tilde = self.peek()
        self.at += 1
        if text in OPEN:
            inner = self.read_all(OPEN[text])
            self.at += 1
            return row([*sign, *inner])
        if kind == "number":
            return row([*sign, element("mn", text)])
        if kind == "name":
            if text.startswith("sum"):
                raise NotAnEquation("a sum in an exponent")
            argument = self.read_base(None)[:1] if text in FUNCTIONS and self.peek()[1] == "(" else []
            return row([*sign, symbol(text, tilde), *argument])
        raise NotAnEquation(f"the exponent {text}")


def convert_inner(text):
    return row(Reader(text).read_all() or [element("mrow")])


def convert(text):
    """A cell as a MathML formula."""
    return f'<math display="inline">{element("mstyle", convert_inner(text), displaystyle="true")}</math>'


def cells_of(line):
    """The parts of a line, and the number of the equation or an empty text."""
    parts, depth = [""], 0
    for piece in re.split(r"( {2,})", line.strip()):
        if not piece.isspace():
            parts[-1] += piece
            depth += sum(map(piece.count, "([{")) - sum(map(piece.count, ")]}"))
        elif depth:
            parts[-1] += " "
        else:
            parts.append("")
    number = ""
    if len(parts) > 1 and NUMBER.fullmatch(parts[-1]):
        number = parts.pop()
    return parts, number


def typeset(block):
    """A block of lines as HTML. NotAnEquation: a line is not understood."""
    lines = [cells_of(line) for line in block.rstrip().splitlines() if line.strip()]
    has_columns = len(lines) > 1 and len({len(cells) for cells, _ in lines}) == 1
    rows = []
    for cells, number in lines:
        shown = [convert(cell) for cell in cells]
        if not has_columns:
            shown = ['<span class="gap"></span>'.join(shown)]
        body = "".join(f"<td>{cell}</td>" for cell in shown)
        rows.append(f'<tr>{body}<td class="number">{number}</td></tr>')
    return f'<div class="equations"><table role="presentation">{"".join(rows)}</table></div>'


def typeset_prose(text):
    """Parts of a running text: (True, MathML of a symbol) and (False, text)."""
    parts, end = [], 0
    for match in PROSE.finditer(text):
        try:
            formula = f'<math display="inline">{convert_inner(match[0])}</math>'
        except NotAnEquation:
            continue
        parts += [(False, text[end:match.start()]), (True, formula)]
        end = match.end()
    return [part for part in [*parts, (False, text[end:])] if part[1]]
