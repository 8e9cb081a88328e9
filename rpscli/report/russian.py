"""Words of a page in Russian: one table, by the English ones.

Terms are those of Russian texts on seismic isolation. A number in a text stands as
`{}`: numbers, symbols, formulas and units pass unchanged. A text without an entry stays
English, and the page says so.
"""

from __future__ import annotations

import re

TERMS = {
    "bearing": "кинематическая опора",
    "column": "опора (стойка)",
    "spherical ends": "сферические торцы",
    "cylindrical ends": "цилиндрические торцы",
    "cap beam": "ростверк (распределительная плита)",
    "building": "надземная часть здания",
    "full contact": "полный контакт торцов",
    "uplift": "отрыв (начало качения)",
    "uplift acceleration": "ускорение отрыва",
    "rolling": "качение",
    "impact": "удар при посадке",
    "rotation": "угол наклона опор",
    "critical rotation": "критический угол наклона",
    "critical displacement": "критическое смещение",
    "restoring moment": "восстанавливающий момент",
    "driving moment": "опрокидывающий момент",
    "overturning": "опрокидывание",
    "rotation ratio": "относительный угол наклона",
    "lift": "подъём здания",
    "residual rotation": "остаточный угол наклона",
    "cap beam displacement": "смещение ростверка",
    "roof displacement": "смещение верха здания",
    "storey shear": "поперечная сила этажа",
    "drift": "перекос этажа",
    "drift ratio": "относительный перекос этажа",
    "ductility": "коэффициент пластичности",
    "plastic drift": "пластический перекос этажа",
    "residual drift": "остаточный перекос этажа",
    "floor acceleration": "ускорение перекрытия",
    "floor velocity": "скорость перекрытия",
    "base shear": "поперечная сила в основании здания",
    "base shear at uplift": "поперечная сила в основании при отрыве",
    "uplift force": "сила отрыва",
    "friction demand": "требуемый коэффициент трения",
    "friction ratio": "отношение требуемого трения к имеющемуся",
    "contact pressure ratio": "относительное контактное давление",
    "crushed width ratio": "относительная ширина смятия",
    "device": "демпфирующее устройство",
    "restitution": "коэффициент восстановления",
    "curvature ratio": "относительный радиус кривизны торца",
    "total mass ratio": "полное отношение масс",
    "fixed base": "жёсткое основание",
}
"""Terms of the glossary, whose column of Russian words is this."""

WORDS = TERMS | {
    "In short": "Кратко",
    "The structure": "Конструкция",
    "Input": "Исходные данные",
    "Derived quantities": "Производные величины",
    "Ground motion": "Акселерограмма",
    "Ground motions": "Акселерограммы",
    "Response": "Реакция сооружения",
    "Forces and pressures of a column": "Усилия и давления в опоре",
    "Limits of the model": "Пределы применимости модели",
    "How to repeat it": "Как повторить расчёт",
    "Target spectrum": "Целевой спектр",
    "Figures": "Рисунки",
    "Statistics": "Статистика",
    "project": "объект",
    "made by": "составил",
    "checked by": "проверил",
    "date, signature:": "дата, подпись:",
    "Figure": "Рисунок",
    "Warning": "Предупреждение",
    "Made by": "Составлено программой",
    "limit": "предельное условие",
    "from": "источник",
    "value": "значение",
    "requirement": "требование",
    "result": "результат",
    "met": "выполнено",
    "EXCEEDED": "ПРЕВЫШЕНО",
    "met, not shown": "выполнено, не доказано",
    "limits of the case": "пределы расчётного случая",
    "no record": "ни при одной записи",
    "All limits are met.": "Все условия выполнены.",
    "All {} limits are met.": "Все условия выполнены, их {}.",
    "at most {} in every record": "не более {} при каждой записи",
    "at most {} in the mean": "не более {} в среднем",
    "{} of {} beyond": "превышено в {} из {}",
    "storey": "этаж",
    "height": "высота",
    "mass m_i": "масса m_i",
    "stiffness k_i": "жёсткость k_i",
    "first mode φ_i": "первая форма φ_i",
    "case": "расчётный случай",
    "record": "запись",
    "key": "ключ",
    "as written": "как задано",
    "value in SI": "значение в СИ",
    "unit": "единица",
    "quantity": "величина",
    "symbol": "обозначение",
    "formula": "формула",
    "with numbers": "с числами",
    "from the case": "задано",
    "semi-diagonal": "полудиагональ опоры",
    "column height": "высота опоры",
    "width of the flat part": "ширина плоской части торца",
    "radius of the arcs": "радиус кривизны торца",
    "slenderness angle": "угол стройности",
    "slenderness angle of the wedge": "угол стройности по краю дуги",
    "rolling ends at": "качение кончается при",
    "critical curvature ratio, first order": (
        "критический радиус кривизны, первое приближение"
    ),
    "critical curvature ratio, exact": "критический радиус кривизны, точно",
    "all columns": "все опоры",
    "superstructure": "надземная часть",
    "cap beam over columns": "ростверк к опорам",
    "superstructure over cap beam": "надземная часть к ростверку",
    "restitution, impulse at the edges": "коэффициент восстановления, импульс на кромках",
    "restitution at impact": "коэффициент восстановления при ударе",
    "restitution at impact e": "коэффициент восстановления при ударе e",
    "uplift acceleration, quasi-static": "ускорение отрыва, квазистатически",
    "weight that is lifted": "поднимаемый вес",
    "uplift force at the cap beam": "сила отрыва на уровне ростверка",
    "stiffness after uplift, at the cap beam": (
        "жёсткость после отрыва, на уровне ростверка"
    ),
    "frequency parameter, rigid estimate": "параметр частоты, жёсткое здание",
    "first period on a fixed base": "первый период на жёстком основании",
    "weight on a column": "вес на одну опору",
    "moment of a column at {} alpha": "момент в опоре при {} alpha",
    "crushed width at its edge": "ширина смятия у кромки",
    "name": "имя",
    "source": "файл",
    "format": "формат",
    "samples": "отсчёты",
    "duration": "длительность",
    "peak acceleration": "пиковое ускорение",
    "Arias intensity": "интенсивность Ариаса",
    "on bearings": "на опорах",
    "normalised": "в долях",
    "elastic, fixed base": "упругое, жёсткое основание",
    "elastic, fixed": "упругое, жёсткое основание",
    "fixed": "жёсткое основание",
    "largest rotation": "наибольший угол наклона опор",
    "time of largest rotation": "время наибольшего угла наклона",
    "lift of the building": "подъём здания",
    "damper force": "сила в демпфере",
    "base shear over fixed base": "поперечная сила к жёсткому основанию",
    "floor acceleration over fixed base": "ускорение перекрытия к жёсткому основанию",
    "uplifts, impacts": "отрывы, удары",
    "friction demand |F|/N": "требуемый коэффициент трения |F|/N",
    "axial force of a column": "продольная сила в опоре",
    "minimum axial force of a column": "наименьшая продольная сила в опоре",
    "shear, most loaded column": "поперечная сила, наиболее нагруженная опора",
    "shear, mean of the columns": "поперечная сила, среднее по опорам",
    "moment at an end of a column": "момент у торца опоры",
    "energy input": "подведённая энергия",
    "  damped": "  рассеяно демпфированием",
    "  in storeys that yield": "  в текущих этажах",
    "  in devices": "  в устройствах",
    "  lost at impacts": "  потеряно при ударах",
    "  still stored": "  ещё накоплено",
    "  residual": "  невязка",
    "shear": "поперечная сила",
    "acceleration": "ускорение",
    "axial force": "продольная сила",
    "moment": "момент",
    "force": "сила",
    "stroke": "ход",
    "velocity": "скорость",
    "energy": "энергия",
    "base shear ratio": "относительная поперечная сила",
    "mean of maxima": "среднее максимумов",
    "median": "медиана",
    "largest": "наибольшее",
    "largest moment": "наибольший момент",
    "axial force at its end": "продольная сила у торца",
    "shear at its end": "поперечная сила у торца",
    "survived": "устояло",
    "at rest": "в покое",
    "overturned": "опрокинулось",
    "Outcome: survived: uplifts and comes back.": "Исход: устояло: отрыв и возврат.",
    "assumed": "принято",
    "what it hides": "что при этом скрыто",
    "size": "величина эффекта",
    "required": "требуется",
    "factor": "множитель",
    "event": "землетрясение",
    "misfit": "невязка",
    "target": "целевой спектр",
    "edition": "издание",
    "checked": "проверено",
    "periods": "периоды",
    "The structure at rest.": "Конструкция в покое.",
    "Storeys, the roof on top:": "Этажи, сверху вниз:",
    "Displacements relative to the ground against time.": (
        "Смещения относительно основания во времени."
    ),
    "Balance of the energy supplied by the ground.": (
        "Баланс энергии, подведённой от основания."
    ),
    "Largest storey shears on the bearings and on a fixed base.": (
        "Наибольшие поперечные силы этажей на опорах и на жёстком основании."
    ),
    "From the folder in which this page was made, with the same versions:": (
        "Из той же папки, теми же версиями:"
    ),
}  # fmt: skip
"""All of them."""

NOTE = (
    "Слова этой страницы переведены по таблице терминов; числа, обозначения, формулы, имена"
    " ключей и рисунки не изменены. Предложения, которых нет в таблице, оставлены на"
    " английском языке. Обязателен английский текст."
)
"""Stands at the top of a page."""

_NUMBER = re.compile(
    r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?:\s(?:mm|kN m|kN|MN|mrad))?"
)
_UNIT = re.compile(r"^(.*?)( \[[^\]]+\]| (?:kN m|kN|kJ|mm|m/s2|m/s|MPa|MN|t|s|m))$")


def in_russian(text: str) -> str:
    """A text of a page, numbers and unit as they are; itself if it has no entry."""
    if text in WORDS:
        return WORDS[text]
    numbers = _NUMBER.findall(text)
    form = WORDS.get(_NUMBER.sub("{}", text))
    if numbers and form is not None:
        return form.format(*numbers)
    if (headed := _UNIT.match(text)) and headed[1] in WORDS:
        return f"{WORDS[headed[1]]}{headed[2]}"
    first, colon, rest = text.partition(": ")
    if first == "Warning" and colon:
        return f"{WORDS[first]}: {rest}"
    return text
