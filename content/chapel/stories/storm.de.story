<story>
<p><emotion name="joy" weight="0.35"/>Bleiben Sie einen Augenblick stehen und <gesture name="listen"/>hören Sie. <break time="500ms"/>Das ist der Wind, der einzige <emphasis>Chor</emphasis>, der dieser Kapelle geblieben ist.</p>

<p><emotion name="sadness" weight="0.4"/>Vor mehr als zweihundert Jahren, in einer Novembernacht, kam er über die Hügel <gesture name="large"/>und riss am Dach.
Der alte Ondrej, der Küster, lief aus dem Dorf herauf, <look at="tomb"/>denn hier drinnen lag ein Herr der Burg in seinem Grab, <look at="visitor"/><gesture name="point_up"/>und über ihm hing ein Gewölbe voller Risse.</p>

<p><emotion name="fear" weight="0.6"/>Kaum brannte seine Laterne, da fiel die <gesture name="count_one"/>erste Rippe. <break time="350ms"/>Dann die <gesture name="count_two"/>zweite.
<prosody volume="soft" rate="90%">Er kroch unter den Bogen der Apsis <gesture name="hush" weight="0.7"/>und zählte die Steine, wie sie herunterkamen.</prosody></p>

<p><emotion name="surprise" weight="0.5"/>Da saß neben ihm im Dunkeln ein <emphasis>Falke</emphasis>, nass und <gesture name="small"/>zitternd.
Er wollte nicht <gesture name="shake_head" weight="0.6"/>fort von der Mauer unter dem Fenster.</p>

<p><emotion name="joy" weight="0.7"/>Am Morgen war kein Dach mehr da. <break time="300ms"/>Aber es war <gesture name="open_arms"/>Licht da, mehr Licht, als hier drinnen je ein Mensch gesehen hatte.
<look at="capital"/>Und jenes Kapitell lag mit dem Gesicht im Putz, und kein Blatt daran war gebrochen.<look at="visitor"/></p>

<p><emotion name="neutral"/>Ondrej erzählte allen, der Falke habe in der Mauer <gesture name="explain" weight="0.7"/>etwas bewacht. Man <gesture name="shrug" weight="0.6"/>lachte.
<prosody rate="90%">Siebzig Jahre vergingen, bis jemand nachsah <emotion name="surprise" weight="0.4"/>und eine <gesture name="wonder"/><emphasis>Krone</emphasis> fand.</prosody></p>

<p><emotion name="joy" weight="0.45"/>Wenn also eines Tages ein Vogel auf Ihrer Mauer sitzt und <gesture name="emphasize" weight="0.7"/>nicht fort will, <break time="300ms"/><prosody rate="88%">verscheuchen Sie ihn nicht.</prosody></p>
</story>
