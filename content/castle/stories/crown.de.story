<story>
<p><emotion name="joy" weight="0.4"/>Haben Sie schon einmal eine Krone gesehen, die nur einen <gesture name="count_one"/>einzigen Tag getragen wurde?
<point at="crown"/>Dort liegt sie.</p>

<p><look at="visitor"/>Königin Adela wurde genau in <gesture name="open_arms"/>diesem Saal gekrönt, am kürzesten Tag des Winters.
<emotion name="sadness" weight="0.4"/>Acht Steine sollte der Goldschmied fassen, doch unterwegs wurde ihm einer <emphasis>gestohlen</emphasis>.
<emotion name="fear" weight="0.6"/>Er hatte solche Angst, dass er nicht schlafen konnte.
<prosody volume="soft" rate="92%">Um Mitternacht <hold name="torch"/>nahm er eine Fackel von der Wand und <gesture name="hush" weight="0.7"/>schlich hier herein, <look at="paintings"/>vorbei an all diesen Gesichtern.</prosody>
Die Flamme <look at="visitor"/>zitterte in seiner Hand, und mit ihr zitterten alle Schatten.
<prosody volume="soft" rate="92%">So schnitt er ein <gesture name="small" weight="0.8"/>kleines Stück aus dem Fenster</prosody> und setzte es ins Gold.</p>

<p><emotion name="surprise" weight="0.4"/>Am Morgen <hold name="nothing"/>hielt der ganze Hof den Atem an.
<break time="400ms"/><emotion name="joy" weight="0.7"/>Dann kam die <gesture name="wonder"/>Sonne herein, und die Steine glühten: <break time="150ms"/>rot <break time="150ms"/>und blau <break time="150ms"/>und grün.
<look at="crown"/><prosody rate="85%">Und der achte leuchtete klar wie Wasser.</prosody></p>

<p><look at="visitor"/><emotion name="neutral"/>Die Königin sah es sofort, <break time="300ms"/>und sie sagte <gesture name="shake_head" weight="0.5"/>nichts.
<emotion name="fear" weight="0.35"/>Sie sagte nichts beim Essen und nichts beim Tanz, und der Goldschmied wurde weiß wie Kerzenwachs.
<break time="300ms"/><emotion name="joy" weight="0.3"/>Spät am Abend nahm sie die Krone vom Kopf und gab sie seiner <gesture name="small" weight="0.8"/>kleinen Tochter.</p>

<p><prosody pitch="+6%" rate="90%">„Ein echter Stein leuchtet für den, der ihn trägt“,</prosody> sagte sie.
<prosody pitch="+6%" rate="88%">„Dieser aber <gesture name="open_arms"/>leuchtet für <emphasis>alle</emphasis>.“</prosody></p>

<p><emotion name="joy" weight="0.5"/>Sie trug die Krone nie wieder, und <gesture name="heart"/>darum können wir sie heute alle sehen.
<look at="crown"/>Zählen Sie ruhig die Steine: <look at="visitor"/>Nur <gesture name="point_up"/>einer davon ist ehrliches Glas.</p>
</story>
