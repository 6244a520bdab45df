<story>
<p><emotion name="joy" weight="0.35"/><show piece="falcon" layer="outside" turn="0" cut="0"/>Kommen Sie <gesture name="beckon"/>her, und begrüßen Sie den stillsten Gast dieses Hauses.
Ein Pilger trug ihn aus Alexandria heim, <gesture name="small" weight="0.8"/>in den Mantel eingenäht, und er schwor, es sei der Falke unseres Brunnens.
<gesture name="shrug" weight="0.6"/><show piece="falcon" turn="30"/>Fünfhundert Jahre lang wusste niemand, was darin war, <break time="250ms"/>denn niemand wagte, das Leinen aufzuschneiden.</p>

<p><emotion name="joy" weight="0.3"/>Sie brauchen kein Messer: <gesture name="explain" weight="0.7"/>Halten Sie das Glas davor, und schauen Sie.
Zuerst geht das Leinen, <show piece="falcon" layer="outside" over="inside" share="0.7" turn="0"/><prosody rate="90%">Lage um Lage um Lage.</prosody>
<emotion name="surprise" weight="0.5"/>Und dann, <break time="400ms"/><show piece="falcon" layer="inside"/>da ist ein <gesture name="wonder"/><emphasis>Vogel</emphasis>!
<show piece="falcon" layer="bone" turn="25"/>Die Flügel sind gefaltet und die Krallen geschlossen, <prosody volume="soft" rate="88%">als wäre er nur <gesture name="hush" weight="0.6"/>eingeschlafen.</prosody>
<emotion name="joy" weight="0.4"/>Sogar seine letzte Mahlzeit ist noch da, <show piece="falcon" layer="bone" turn="-20"/>eine <gesture name="small"/>Maus.</p>

<p><emotion name="surprise" weight="0.4"/>Nun sehen Sie sich das <gesture name="point_near"/>linke Bein an.
Das ist <show piece="falcon" layer="xray" turn="20"/>ein Ring aus <emphasis>Gold</emphasis>, und für einen Falken ist er viel zu weit.
<emotion name="sadness" weight="0.4"/>Jemand zog ihn vom eigenen <gesture name="heart"/>Finger, <break time="250ms"/><prosody rate="86%">ehe die letzte Binde gewickelt wurde.</prosody></p>

<p><emotion name="fear" weight="0.35"/>Und <show piece="falcon" layer="outside" turn="-35"/>der Riss im bemalten Kopf, <gesture name="sigh"/>nun, das war ich.
Noch am Tag seiner Ankunft ließ ich ihn <emphasis>fallen</emphasis>.
Ich schloss den Riss <show piece="falcon" layer="metal"/>mit Harz und einem <gesture name="small" weight="0.8"/>Stift aus Glockenmetall, malte darüber und sagte es <gesture name="shake_head" weight="0.5"/>niemandem.
<break time="300ms"/><emotion name="joy" weight="0.6"/>Es wäre für immer mein Geheimnis geblieben, <break time="200ms"/>hätte man Ihnen nicht <show piece="falcon" layer="outside" turn="0"/>dieses <gesture name="laugh" weight="0.7"/>Glas gegeben.</p>
</story>
