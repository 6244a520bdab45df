<story>
<p><emotion name="joy" weight="0.4"/>Videli ste už korunu, ktorú niekto nosil iba <gesture name="count_one"/>jediný deň?
<point at="crown"/>Tam leží.</p>

<p><look at="visitor"/>Kráľovnú Adelu korunovali práve v <gesture name="open_arms"/>tejto sále, v najkratší zimný deň.
<emotion name="sadness" weight="0.4"/>Zlatník do nej mal vsadiť osem kameňov, no jeden mu cestou <emphasis>ukradli</emphasis>.
<emotion name="fear" weight="0.6"/>Tak sa bál, že nemohol spať.
<prosody volume="soft" rate="92%">O polnoci <hold name="torch"/>vzal zo steny fakľu a <gesture name="hush" weight="0.7"/>vkradol sa sem, <look at="paintings"/>popri všetkých týchto tvárach.</prosody>
Plameň <look at="visitor"/>sa mu v ruke triasol a s ním sa triasli všetky tiene.
<prosody volume="soft" rate="92%">Tak vyrezal z okna <gesture name="small" weight="0.8"/>malý kúsok skla</prosody> a vsadil ho do zlata.</p>

<p><emotion name="surprise" weight="0.4"/>Ráno <hold name="nothing"/>celý dvor zatajil dych.
<break time="400ms"/><emotion name="joy" weight="0.7"/>Potom dnu zasvietilo <gesture name="wonder"/>slnko a kamene sa rozžiarili: <break time="150ms"/>načerveno, <break time="150ms"/>namodro <break time="150ms"/>a nazeleno.
<look at="crown"/><prosody rate="85%">A ten ôsmy sa trblietal ako voda.</prosody></p>

<p><look at="visitor"/><emotion name="neutral"/>Kráľovná to zbadala hneď <break time="300ms"/>a nepovedala <gesture name="shake_head" weight="0.5"/>nič.
<emotion name="fear" weight="0.35"/>Nepovedala nič pri večeri a nič pri tanci a zlatník zbledol ako vosk.
<break time="300ms"/><emotion name="joy" weight="0.3"/>Neskoro večer si korunu sňala z hlavy a dala ju jeho <gesture name="small" weight="0.8"/>malej dcére.</p>

<p><prosody pitch="+6%" rate="90%">„Pravý kameň žiari tomu, kto ho nosí,“</prosody> povedala.
<prosody pitch="+6%" rate="88%">„Ale tento <gesture name="open_arms"/>žiari <emphasis>všetkým</emphasis>.“</prosody></p>

<p><emotion name="joy" weight="0.5"/>Korunu si už nikdy nenasadila, a <gesture name="heart"/>preto ju dnes môžeme vidieť my všetci.
<look at="crown"/>Spočítajte si kamene: <look at="visitor"/>iba <gesture name="point_up"/>jeden z nich je poctivé sklo.</p>
</story>
