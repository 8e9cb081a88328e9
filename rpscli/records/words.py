"""Words of headers, titles and names of files, compared without accents and case.

The one vocabulary of what a key of a header is about. Stems of four letters and more are
also found at the beginning of longer words, and those of other scripts anywhere in them.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection

from rpscli.errors import foreign_letters

_ALONE = str.maketrans({"ı": "i", "ø": "o", "ł": "l", "đ": "d", "−": "-", "’": "'"})


def folded(text: str) -> str:
    """A text in small letters without accents.

    >>> folded("Düşey"), folded("ÉCHELLE"), folded("DUSEY")
    ('dusey', 'echelle', 'dusey')
    """
    apart = unicodedata.normalize("NFKD", text.translate(_ALONE)).casefold()
    plain = "".join(each for each in apart if not unicodedata.combining(each))
    return plain.translate(_ALONE)


def words_of(text: str) -> list[str]:
    """The words of a text, folded; digits and punctuation part them."""
    return re.findall(r"[^\W\d_]+", folded(text))


def speaks_of(text: str, vocabulary: Collection[str]) -> bool:
    """True if a word of a text is in a vocabulary, or begins with a stem of it."""
    return any(_begins(word, vocabulary) for word in words_of(text))


def _begins(word: str, vocabulary: Collection[str]) -> bool:
    if word in vocabulary:
        return True
    if not word.isascii():
        return any(len(stem) > 1 and stem in word for stem in vocabulary)
    return any(word[:n] in vocabulary for n in range(4, len(word)))


def look_alikes(text: str) -> str:
    """Characters that look like others, by their names; none of words of another script.

    >>> look_alikes("c\u043c/s2"), look_alikes("\u0441\u043c")
    (" ('\u043c' in it is U+043C, CYRILLIC SMALL LETTER EM)", '')
    """
    odd = ""
    for word in re.findall(r"[^\W\d_]+", text):
        strange = [c for c in word if not folded(c).isascii() or "\uff00" < c < "\uffef"]
        if strange and (len(strange) < len(word) or len(word) == 1):
            odd += "".join(strange)
    return foreign_letters(odd)


def vocabulary(text: str) -> frozenset[str]:
    """Words between blanks, folded."""
    return frozenset(map(folded, text.split()))


FACTORS = vocabulary(
    "factor factors faktor facteur fattore fator coefficient coeff coefficiente"
    " koeffizient"
    " katsayi katsayisi carpan scale scaling scalefactor echelle escala scala massstab"
    " olcek skala skalier masshtab масштаб коэффициент множитель коеф multipl mult"
    " multiplier sf calib calibration kalibrier kalibrasyon kalibr gain amplif verstark"
    " kazanc sensib lsb counts count conversion convers umrechn donusum divis divid"
    " teiler"
    " normali normier resolution resolucion auflosung cozunurluk bili beilv beishu xishu"
    " baritsu keisu bairitsu 倍率 係数 系数 比例 換算 συντελεστης κλιμακα wspolczynnik"
    " skalowan mnoznik multiplicador multiplicateur moltiplicatore weight"
)
"""What is said of a factor on the values."""

TIMES = vocabulary(
    "at bei time times hora heure ora uhr uhrzeit saat jam время 時刻 时刻 时间 utc gmt jst"
    " temps"
    " tiempo tempo zaman zeit"
)
NOT_OF_THE_MOTION = vocabulary(
    "lat latitude latitud latitudine breite breitengrad enlem широта 緯度 纬度 szerokosc"
    " lon long lng longitude longitud longitudine lange langengrad boylam долгота 経度 经度"
    " coord coordinates koordin easting northing utm"
    " mag magnitude magnitud magnitudo buyukluk buyuklugu магнитуда 規模 震级 m mw ml ms mb"
    " mj md mwg moment dist distance distancia distanza distanz entfernung uzaklik mesafe"
    " расстояние 距離 距离 odleglosc repi rjb rrup rhyp rx ry epic epicen epicentre"
    " hypo hypocen ipocent focal foco focus depth tiefe derinlik profondeur profundidad"
    " profundidade profondita глубина 深さ 深度 glebokosc"
    " vs vs30 soil site class zone terrain ground geology clase boden zemin"
    " corner cutoff cut hp lp hpf lpf highpass lowpass bandpass high low filter filtre"
    " filtro filtrage filt фильтр npass pole poles ripple taper butterworth"
    " order ordre orden ordnung ordine mertebe npol nroll"
    " id no nr serial seri serie record recno rec rsn eqid ssn evid case file line lines"
    " header page part volume vol version ver release copy tel phone fax zip code"
    " year date datum fecha fech tarih jahr annee ano дата год 年 日付 日期"
    ""
    " damping damp dampfung amortiguamiento amortissement smorzamento sonum затухание"
    " natural nat azimuth azimut acimut strike dip rake slip inc inclination cmpinc cmpaz"
    " elev elevation altitude alt altitud altitudine kot quota height hohe altura"
    " yukseklik"
    " hauteur высота 標高 高程 intensity mmi msk jma siddet stress fault arias ia cav pgv pgd"
    " housner temperature battery gps latency network trigger threshold tetik umbral"
    " soglia bits bit adc channels channel canal kanal chan ch station sta array"
    " component"
    " comp location floor pre preevent posttrigger postevent delay latenz offset mean"
    " average"
    " mittelwert media moyenne promedio ortalama baseline zero start begin end"
    " duration dauer"
    " duracion duree durata sure suresi длительность usable bandwidth nyquist checksum"
    " crc doi licence license commit revision title orcid grant copyright http https mo"
    " firmware git table figure fig realization realisation jday doy z1 z2 snr ratio"
    " km az fc flo fhi rms std iso odak derinligi back backazimuth incidence ray sv velocity"
    " vel displacement disp rupture rvt seed"
)
"""What is said of the earthquake, the station, the instrument, the file."""
NOT_OF_THE_MOTION |= TIMES

PEAKS = vocabulary(
    "pga pha pgah pgav peak amax max maximum maximal maximale maxima maximo massimo"
    " massima"
    " maksimum maksimal maxi picco pico pic spitze spitzen spitzenwert"
    " spitzenbeschleunigung"
    " buyuk tepe максимум макс максимальное пик пиковое saidai zuida 最大 μεγιστη szczyt"
)
"""What is said of a largest value."""

LIMITS = vocabulary(
    "full fullscale fs range clip clipping saturation messbereich rango trigger"
    " threshold umbral soglia tetik max_range"
)
"""What is said of the range of an instrument, in units of acceleration."""

SAMPLING = vocabulary(
    "sampl sampling samplerate abtast campion muestre muestra echantill orneklem дискрет"
    " опрос 采样 取样 採樣 取樣 サンプリング サンフリンク δειγματ amostra caiyang vzork probkow"
    " sps fs"
)
STEPS = vocabulary(
    "increment incremento inkrement spacing zeitinkrement tidssteg tijdstap"
    " dt delta step timestep paso pas passo adim adimi adimlari schritt zeitschritt"
    " schrittweite интервал шаг 間隔 间隔 刻み krok korak intervalo intervalle intervall"
    " intervallo aralig araligi interval bu buchang kankaku"
)
"""What is said of the time between samples."""

COUNTED = vocabulary(
    "npts ndata points point samples data datos dati daten werte values valores valori"
    " veri nokta deger degerler punti puntos punkte echantillons donnees valeurs точек"
    " отсчет отсчетов данных 点数 点 データ数 テータ 数据 anzahl pontos dados probek"
)
"""What is counted: with a number of them, that of the values."""
SERIALS = vocabulary(
    "format version type page set file base bank center centre id serial"
)

DIRECTIONS = vocabulary(
    "component comp componente composante komponente komponent bilesen bileseni"
    " компонента компонент kanal channel chan canal canale direction direccion direzione"
    " direcao dir richtung yon yonu направление sens sentido sensor_orientation"
    " orientation"
    " orientacion orientazione orientamento ausrichtung azimuth azimut acimut azimuth_deg"
    " heading hcomp fangxiang fangwei hoko houkou 方向 方位 成分 分量 συνιστωσα διευθυνση"
    " skladowa kierunek slozka smer axis eje asse achse eksen ось axe orient"
)
"""What is said of the direction of a component."""

EARTHQUAKES = vocabulary(
    "sisma gempa potres cutremur zemljotres"
    " event evento evenement ereignis olay earthquake eq deprem depremi terremoto sismo"
    " erdbeben"
    " seisme землетрясение 地震 jishin dizhen σεισμος trzesienie zemetreseni"
)
"""What is said of the earthquake."""

PLACES = vocabulary(
    "location loc position installation sensor instrument structure placement mounted"
    " mounting lage standort aufstellung ubicacion ubicazione emplacement posizione"
    " posicion"
    " posicao konum konumu yeri расположение место установка 設置 设置 位置 設置場所 θεση"
    " umiejscowienie umisteni"
)
"""What is said of where an instrument stands."""

STRUCTURES = vocabulary(
    "roof rooftop basement cellar attic mezzanine penthouse terrace storey story floor"
    " building bridge deck pier pylon abutment midspan girder dam crest spillway tower"
    " chimney tunnel slab column beam foundation pile underground"
    " azotea techo sotano edificio puente presa pila cubierta terraza"
    " toit sous-sol immeuble pont barrage etage terrasse"
    " dach dachgeschoss keller geschoss stockwerk gebaude brucke talsperre"
    " copertura tetto interrato piano edificio ponte diga terrazzo"
    " cati bodrum bina kopru baraj kule zemin-kat"
    " крыша подвал этаж здание мост плотина"
    " damcrest bridgedeck toiture vault 屋上 地下室 地階 階 建物 橋 ダム 屋顶 楼 大坝 桥 층 옥상"
)
"""Buildings, dams and bridges, and parts of them."""

STOREYS = re.compile(
    r"(?<![^\W_])(?:[1-9]\d?f|b\d{1,2}f?|rf|phf?|l[1-9]\d|l(?:evel|vl)[ _-]?[1-9]\d?"
    r"|\d{1,2}\.?[ _-]?(?:og|ug|stock|etage|kat|piano|th|st|nd|rd)"
    r"|(?:floor|storey|story|level|kat|etage|piso|piano)[ _-]?-?\d{1,2}"
    r"|zemin[ _-]kat|sous[ _-]sol|eg|\d{1,2}[ _-]?(?:storey|story|floor)s?)(?![^\W_])"
)
"""A storey of a building by its number, folded."""


_SITES = vocabulary("dam bridge tower building presa ponte puente pont diga baraj kopru")
"""Words that names of sites end with."""
_NAMES_OF_STREETS = frozenset(
    ("road", "rd", "street", "school", "park", "avenue", "lane")
)
_FREE_FIELD = re.compile(
    r"free[\s_-]?field|ground surface|freifeld|campo libero|campo libre"
)


def says_free_field(text: str) -> bool:
    """True of words for the free surface of the ground."""
    return _FREE_FIELD.search(folded(text)) is not None


def says_structure(text: str) -> bool:
    """True of words for a place in a structure, not of streets that are called so.

    >>> [says_structure(text) for text in ("Dachgeschoss", "B2F", "Tower Bridge Road", "Pierce")]
    [True, True, False, False]
    """
    words = words_of(text)
    if says_free_field(text) or (words[-1:] and words[-1] in _NAMES_OF_STREETS):
        return False
    inside = any(
        word in STRUCTURES or (not word.isascii() and _begins(word, STRUCTURES))
        for word in words
    )
    return inside or STOREYS.search(folded(text)) is not None


def stands_in_a_structure(name: str) -> bool:
    """True of the name of a file that says a place in a structure.

    >>> [stands_in_a_structure(name) for name in ("st_10F_E", "ABC_roof", "CHB002", "L12")]
    [True, True, False, False]
    """
    plain = folded(name)
    inside = any(word in STRUCTURES - _SITES for word in words_of(name)[1:])
    return inside or re.search(rf"(?<=[^a-z0-9]){STOREYS.pattern}", plain) is not None


ORIGINS = EARTHQUAKES | vocabulary(
    "origin origine origen origem ot herd herdzeit ursprung ursprungszeit очаге очага"
    " 発震 発震時 発生 发震 olus olusum olusumu"
)
"""What is said of the time of the earthquake."""
DATES = vocabulary("date datum fecha data tarih tarihi дата 日付 日期 dato jour")
OF_THE_FILE = vocabulary(
    "start begin beginning first trigger triggered record recorded recording registro"
    " process processed processing created creation printed converted exported export"
    " file last end stop sample accessed download downloaded modified version release"
    " kayit запис начало 記録 tetik erstellt aufzeichnung beginn anfang debut"
    " enregistrement inizio inicio fin"
)
"""What is said of times that are not those of the earthquake."""

COUNTRIES = vocabulary(
    "turkey turkiye taiwan japan italy italia iran chile mexico greece zealand nepal"
    " usa ca"
    " california calif nevada alaska armenia china peru india romania croatia ecuador"
)
NO_NAMES = vocabulary(
    "earthquake eq event of record the sequence mainshock aftershock deprem depremi sismo"
    " terremoto erdbeben seisme near off coast north south east west central new utc"
    " gmt jst"
    " jan feb mar apr may jun jul aug sep oct nov dec january february march april"
    " june july"
    " august september october november december"
)
"""Words beside the name of an earthquake."""

OTHER_QUANTITIES = vocabulary(
    "velocity velocities vel velocidad velocita velocidade vitesse geschwindigkeit hiz"
    " скорость sebesseg predkosc rychlost snelheid ταχυτητα 速度 sokudo sudu kine"
    " displacement displacements disp displ deplacement verschiebung desplazamiento"
    " spostamento deslocamento yerdegistirme degistirme перемещение смещение"
    " przemieszczenie"
    " 変位 变位 位移 jerk strain dehnung deformacion counts cuentas coups zahlimpulse"
    " digits volt volts mv speed hastighet brzina kecepatan viteza nopeus سرعت 속도"
    " ความเร็ว"
    " pomak deplasare μετατοπιση pressure rotation gyro angular pore"
)
"""Quantities that are no acceleration, and readings of instruments."""
BESIDE_QUANTITIES = vocabulary(
    "type data signal quantity quantite grandezza magnitud kind channel of the du de der"
    " yer in unit units unidad unidades einheit birim unita единица единицы soil sol"
    " suelo"
    " rate digital bit ground boden zemin kaydi kayit record recording zapis запись s sec с сек"
)
"""Words beside them that say nothing else."""

NO_SERIES = vocabulary(
    "spectrum spectra spectral spektr spektral spektrum spectre spettro spettri espectro"
    " fourier psd fas psa psv uhs arias husid hazard widmo φασμα спектр スペクトル 応答譜"
    " 反应谱"
    " 谱 譜 transfer autocorrelation correlation eigenvalue eigenvalues cyclic protocol"
    " pushover hysteresis wavelet coefficients gmpe envelope"
)
"""Tables of other things than a motion over time."""

UNITS = vocabulary(
    "unit units unidad unidades unita unite unites einheit einheiten birim birimi единица"
    " единицы ед 単位 单位 unidade jednotka jednostka mertekegyseg eenheid enhet danwei tani"
    " μοναδα μοναδες"
)
