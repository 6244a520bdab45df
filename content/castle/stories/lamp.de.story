<story>
<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Trauen Sie <gesture name="think" weight="0.7"/>Ihren Augen?
<point at="alexandrite"/>Dort drüben liegt ein Stein, und bei Tag ist er so grün wie Moos.</p>

<p><look at="visitor"/>Ein Händler <gesture name="explain" weight="0.7"/>brachte ihn in diesen Saal und schwor, er sei ein Smaragd.
<emotion name="surprise" weight="0.3"/>Der Burgherr hielt ihn den ganzen Vormittag ans Fenster, und dann bezahlte er ihn mit <gesture name="count_three"/>drei guten Feldern.
<emotion name="neutral"/>Am Abend schenkte er ihn bei Tisch seiner Frau.
<prosody rate="90%"><hold name="torch"/>Die Kerzen wurden angezündet, sie öffnete die Hand,</prosody> <break time="400ms"/><emotion name="surprise" weight="0.7"/>und der Stein war <emphasis>rot</emphasis>.</p>

<p><emotion name="fear" weight="0.5"/>Er rief nach der Wache, und er rief nach dem Priester.
<prosody volume="soft" rate="90%">Die ganze Nacht saßen sie um ihn herum, <gesture name="hush" weight="0.6"/>und die ganze Nacht blieb er rot wie Wein.</prosody>
<hold name="nothing"/><break time="300ms"/><emotion name="joy" weight="0.6"/>Dann kam die <gesture name="wonder"/>Sonne durch diese Fenster herein, <break time="150ms"/>und da lag er und war grün.</p>

<p><look at="alexandrite"/><emotion name="neutral"/>Niemand hatte ihn betrogen.
<look at="visitor"/>Der Stein behält Gelb und Violett für sich <gesture name="explain"/>und gibt alles andere zurück.
Vom Tageslicht bleibt da Grün, <break time="200ms"/>und von einer Kerze, die kaum Blau hat, <gesture name="point_up" weight="0.8"/>bleibt Rot.</p>

<p><emotion name="joy" weight="0.35"/><point at="second-falcon"/>Und das Gemälde am Tor hütet ein Geheimnis von derselben Art.
<look at="visitor"/>Einst waren <gesture name="count_two"/>zwei Falken an seinem Himmel, und einen hat jemand übermalt.
<prosody volume="soft" rate="92%">Bei Tag wird ihn niemand je finden.</prosody>
<show piece="second-falcon" layer="candle"/><gesture name="beckon" weight="0.7"/>Sehen Sie es unter einer anderen Lampe an.</p>

<p><emotion name="joy" weight="0.5"/>„Aber welche Farbe hat er <emphasis>wirklich</emphasis>?“, fragen alle Kinder.
<look at="alexandrite"/>Die Burgherrin wusste die Antwort, und sie trug den Stein ihr Leben lang.
<look at="visitor"/><prosody pitch="+6%" rate="88%">„Sag mir <gesture name="heart"/>zuerst“, sagte sie, „in wessen Licht.“</prosody></p>
</story>
