<story>
<p><emotion name="joy" weight="0.35"/>Kommen Sie <gesture name="beckon"/>näher, denn diese Geschichte erzählt man am besten leise.
<look at="well"/>Als diese Burg gebaut wurde, gab es auf dem Berg keinen Tropfen <emphasis>Wasser</emphasis>.<look at="visitor"/></p>

<p><emotion name="sadness" weight="0.5"/>Ein junger Maurer namens Matej grub <gesture name="count_three"/>drei Sommer lang,
und drei Sommer lang fand er nur trockenen Stein.
<prosody rate="90%">Die anderen lachten ihn aus,</prosody> <break time="300ms"/>und dann lachten sie nicht mehr,
<gesture name="shake_head" weight="0.6"/>und das war schlimmer.</p>

<p><emotion name="surprise" weight="0.4"/>Eines Abends setzte sich ein <emphasis>Falke</emphasis> auf den Rand des Schachtes und wollte nicht mehr fort.
<emotion name="joy" weight="0.3"/>Matej hatte noch einen halben Laib Brot, also teilte er ihn mit dem Vogel, <gesture name="small"/>Krume für Krume.
<break time="400ms"/><emotion name="surprise" weight="0.6"/>Am Morgen sah der Falke ihn an, legte die Flügel an
und <gesture name="point_near"/>stürzte sich geradewegs hinab ins Dunkel.</p>

<p><emotion name="neutral"/>Was hätten <gesture name="shrug" weight="0.5"/>Sie getan?
<emotion name="fear" weight="0.5"/>Er <emphasis>stieg</emphasis> ihm nach, <prosody rate="92%">tiefer als je zuvor</prosody>,
bis der Himmel über ihm nicht <gesture name="small"/>größer war als eine Münze.
Und da <gesture name="listen"/>hörte er es: <break time="600ms"/><prosody volume="soft" rate="85%">Hinter dem Fels, da sang etwas.</prosody></p>

<p><emotion name="joy" weight="0.85"/>Ein <gesture name="emphasize"/><emphasis level="strong">einziges</emphasis> Mal schwang er den Hammer, und die Quelle brach hervor!
Wie eine Hand hob sie ihn hinauf, <gesture name="wonder"/>siebzig Meter hoch, bis ans Licht.</p>

<p><emotion name="joy" weight="0.4"/><point at="well"/>Dort drüben ist er, und seit jenem Tag bewahrt der Brunnen jede Stimme, die in ihn hineinruft.
<look at="visitor"/>Jedes <gesture name="explain" weight="0.7"/>Lied, jedes Geheimnis, <prosody rate="85%">jeden Namen.</prosody></p>

<p>Wenn Sie sich also an einem stillen Abend über ihn beugen und den <gesture name="hush"/>Atem anhalten, <break time="700ms"/>dann hören Sie vielleicht Matej lachen.</p>
</story>
